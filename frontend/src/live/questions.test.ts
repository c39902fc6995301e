import { describe, expect, it } from 'vitest';

import { entry } from './samples';

import { answering, askedAnew, conversation, offering, openQuestions, wishing } from './questions';

const question = (id: string, seq: number, target: string, state: 'open' | 'answered' = 'open') =>
  entry({ id, seq, targets: [target], type: 'request', question: state });

const NONE: ReadonlySet<string> = new Set();

describe('open questions', () => {
  it('are the newest that still await an answer, per robot', () => {
    const open = openQuestions([
      question('q1', 1, 'Ada'),
      question('q2', 2, 'Ada'),
      question('q3', 3, 'Bob', 'answered'),
    ], NONE);
    expect([...open.keys()]).toEqual(['Ada']);
    expect(open.get('Ada')?.id).toBe('q2');
  });

  it('are not those that somebody has just answered', () => {
    const both = [question('q1', 1, 'Ada'), question('q2', 2, 'Ada')];
    expect(openQuestions(both, new Set(['q2'])).get('Ada')?.id).toBe('q1');
    expect(openQuestions(both, new Set(['q1', 'q2'])).size).toBe(0);
  });
});

it('says of a question that it was not answered where the robot asks the same right after', () => {
  const asks = (seq: number) => entry({ id: `q${seq}`, seq, targets: ['Ada'], message: 'Which one?', type: 'request', question: 'answered' });
  const says = (seq: number, who: 'operator' | 'robot') => entry({ id: `s${seq}`, seq, who, targets: ['Ada'] });
  const chat = [asks(1), says(2, 'operator'), says(3, 'robot'), asks(4), says(5, 'operator'), says(6, 'robot'), says(7, 'operator'), asks(8)];
  expect([...askedAnew(chat)]).toEqual(['q1']); // what was asked by another order later is no repetition
});

describe('a message to several robots', () => {
  it('answers those that asked and is a request to the others', () => {
    const open = openQuestions([question('q1', 1, 'Ada')], NONE);
    const answer = answering(open, ['Ada', 'Bob']);
    expect(answer.question?.id).toBe('q1');
    expect(answer).toMatchObject({ robots: ['Ada'], others: ['Bob'] });
  });

  it('is a plain request when none of them asked', () => {
    const open = openQuestions([question('q1', 1, 'Ada')], NONE);
    expect(answering(open, ['Bob']).question).toBeNull();
  });
});

describe('the conversation with several robots', () => {
  it('holds what was said to two of them once', () => {
    const chat = [
      entry({ id: 'both', targets: ['Ada', 'Bob'] }),
      entry({ id: 'other', targets: ['Cleo'] }),
      entry({ id: 'all', targets: [] }),
    ];
    expect(conversation(chat, ['Ada', 'Bob']).map((one) => one.id)).toEqual(['both', 'all']);
  });

  it('holds what another one says that was called, but not what one says that is not spoken to any more', () => {
    const reply = (id: string, robot: string, reply_to: string) => entry({ id, who: 'robot', targets: [robot], reply_to });
    const chat = [
      entry({ id: 'Bob, stop', who: 'operator', targets: ['Ada'] }),
      reply('stopped', 'Bob', 'Bob, stop'),
      entry({ id: 'stop', who: 'operator', targets: ['Ada', 'Bob'] }),
      reply('stopped too', 'Bob', 'stop'),
      reply('of old', 'Bob', ''),
    ];
    expect(conversation(chat, ['Ada']).map((one) => one.id)).toEqual(['Bob, stop', 'stopped', 'stop']);
  });
});

it('asks for a yes in the newest message of a robot that says so, as long as something waits', () => {
  const wish = (id: string, robot: string) => entry({ id, targets: [robot], asks_yes: true });
  const chat = [wish('old', 'Ada'), wish('new', 'Ada'), wish('other', 'Bob'), entry({ id: 'said', targets: ['Ada'] })];
  expect([...wishing(chat, [{ robot: 'Ada' }])]).toEqual(['new']);
  expect([...wishing(chat, [{ robot: 'Ada' }, { robot: 'Ada' }])]).toEqual(['new', 'old']);
  expect([...wishing(chat, [])]).toEqual([]);
});

describe('offered answers', () => {
  const offer = entry({ id: 'offer', choices: ['left', 'right'] });

  it('of a plain reply can be tapped until the robot is told something', () => {
    expect([...offering([offer])]).toEqual(['offer']);
    expect([...offering([offer, entry({ id: 'said', who: 'operator', targets: ['Ada'] })])]).toEqual([]);
    expect([...offering([offer, entry({ id: 'said', who: 'operator', targets: ['Bob'] })])]).toEqual(['offer']);
  });

  it('of a robot that was called elsewhere can be tapped until it replied to what was said there', () => {
    const asked = [entry({ id: 'one', who: 'operator', targets: ['Bob'] }), entry({ ...offer, reply_to: 'one' })];
    const answered = [entry({ id: 'two', who: 'operator', targets: ['Bob'] }), entry({ id: 'reply', reply_to: 'two' })];
    expect([...offering(asked)]).toEqual(['offer']);
    expect([...offering([...asked, ...answered])]).toEqual([]);
  });

  it('of a question can be tapped until it is answered', () => {
    const asked = { ...question('q', 1, 'Ada'), choices: ['yes'] };
    const said = entry({ id: 'said', who: 'operator' });
    expect([...offering([asked, said])]).toEqual(['q']);
    expect([...offering([{ ...asked, question: 'closed' }])]).toEqual([]);
  });
});
