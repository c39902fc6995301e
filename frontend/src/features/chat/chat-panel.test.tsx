import { act, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { entry, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import type { Snapshot } from '@/live/types';
import { useDrafts } from '@/state/drafts';
import { usePrefs } from '@/state/prefs';

import { ChatPanel } from './chat-panel';
import { useOutbox } from '@/state/outbox';

type Sent = { text: string; targets: string[]; reply_to: string };

/** The network: records what is sent and answers as told. */
const sent: Sent[] = [];
let answers: (() => Response)[] = [];

beforeEach(() => {
  sent.length = 0;
  answers = [];
  useOutbox.setState({ messages: [] });
  useDrafts.setState({ drafts: {} });
  usePrefs.setState({ debug: false });
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    sent.push(JSON.parse(String(options.body)) as Sent);
    return Promise.resolve((answers.shift() ?? (() => new Response('{}')))());
  });
});

const show = (part: Partial<Snapshot>) => {
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), robot({ name: 'Bob' })], ...part }));
  render(<ChatPanel />);
  return userEvent.setup();
};

const tab = (name: string) => within(screen.getByRole('group', { name: 'Robots you talk to' })).getByRole('button', { name: new RegExp(name) });

describe('the chat', () => {
  it('sends an example with one tap', async () => {
    const user = show({});
    await user.click(screen.getByRole('button', { name: 'Go to the door.' }));
    expect(sent).toMatchObject([{ text: 'Go to the door.', targets: ['Ada'], reply_to: '' }]);
  });

  it('lets what waits for a yes be answered where the talk is, and marks the robot', async () => {
    const place = [{ name: 'pose::position::x', type: 'number', value: null }];
    const steps = [step({ id: 'a', label: 'find out where “door” is', only_finds: true, outputs: place }), step({ id: 'b', label: 'go to “door”', inputs: place })];
    const proposal = { id: 'p1', robot: 'Ada', message: '', changes: ['Forget “box”'], steps, digest: 'd1', why: '' };
    const user = show({ proposals: [proposal] });
    expect(tab('Ada').textContent).toContain('Ada is waiting for your answer');
    const ask = screen.getByRole('region', { name: 'Ada waits for your yes' });
    within(ask).getByText('Forget “box” · Go to “door”');
    await user.click(within(ask).getByRole('button', { name: 'No' }));
    expect(sent).toEqual([{ id: 'p1', digest: 'd1', decision: 'reject' }]);
  });

  it('does not say of what somebody else said that oneself did', async () => {
    const user = show({});
    await user.type(screen.getByRole('textbox'), 'hello from me{Enter}');
    await vi.waitFor(() => expect(sent).toHaveLength(1));
    const [own] = sent as unknown as { id: string }[];
    const said = (id: string, device: string, author = '') => entry({ id, device, author, who: 'operator', targets: ['Ada'] });
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], chat: [said(own?.id ?? '', 'page on a phone'), said('a', 'page on a phone'), said('b', ''), said('c', '', 'Kim')] })));
    const names = screen.getAllByText('to Ada').map((to) => to.previousElementSibling?.textContent);
    expect(names).toEqual(['You', 'Somebody (page on a phone)', 'Somebody', 'Kim']);
  });

  it('talks to one robot by a click and to several by a click with Shift', async () => {
    const user = show({});
    await user.click(tab('Bob'));
    await user.keyboard('{Shift>}');
    await user.click(tab('Ada'));
    await user.keyboard('{/Shift}');
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada and Bob' }), 'come here{Enter}');
    expect(sent).toMatchObject([{ text: 'come here', targets: ['Ada', 'Bob'] }]);
  });

  it('brings the tab of a robot that asks into sight', () => {
    const seen: unknown[] = [];
    vi.spyOn(Element.prototype, 'scrollIntoView').mockImplementation(function (this: Element) {
      seen.push(this);
    });
    show({ chat: [entry({ id: 'q', type: 'request', question: 'open', message: 'Which box?', targets: ['Bob'] })] });
    expect(seen).toContain(tab('Bob'));
    vi.restoreAllMocks();
  });

  it('says who is not connected before one writes to them', () => {
    show({ robots: [robot({ name: 'Ada', connection: 'lost' })] });
    screen.getByText('Ada is not connected'); // above the line one writes in
    expect(screen.getByRole('group', { name: 'How Ada fares' }).textContent).toContain('Not connected');
  });

  it('speaks of missing robots only when it knows', () => {
    render(<ChatPanel />);
    screen.getByText('Loading…');
    expect(screen.queryByText('Waiting for a robot')).toBeNull();
    act(() => useLive.getState().setConnection('lost', 1));
    screen.getByText('Not connected. Trying again…');
    screen.getByRole('textbox', { name: 'Not connected. Trying again…' });
  });

  it('tells at its tab how a robot fares', () => {
    const stopped = robot({ name: 'Ada', state: 'stopped' });
    show({ robots: [stopped, robot({ name: 'Bob', state: 'running' })] });
    expect([tab('Ada').textContent, tab('Bob').textContent]).toEqual(['Ada Stopped', 'Bob Working']);
    act(() => useLive.getState().setConnection('lost', 1));
    expect(tab('Bob').textContent).toBe('Bob Not known');
  });

  it('ends a search with Escape and goes back to writing', async () => {
    const user = show({});
    await user.click(screen.getByRole('button', { name: 'Search the conversation' }));
    await user.keyboard('{Escape}');
    expect(screen.queryByRole('search')).toBeNull();
    expect(document.activeElement).toBe(screen.getByRole('textbox', { name: 'Write to Ada' }));
  });

  it('sends one message after the other, in the order in which they were written', async () => {
    let answer: (response: Response) => void = () => undefined;
    vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
      sent.push(JSON.parse(String(options.body)) as Sent);
      return sent.length > 1 ? Promise.resolve(new Response('{}')) : new Promise<Response>((resolve) => (answer = resolve));
    });
    const user = show({});
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'first{Enter}');
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'second{Enter}');
    expect(sent.map((one) => one.text)).toEqual(['first']);
    answer(new Response('{}'));
    await vi.waitFor(() => expect(sent.map((one) => one.text)).toEqual(['first', 'second']));
  });

  it('does not send anew what was said long ago, once it is out of the part that is held', async () => {
    const user = show({});
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'long ago{Enter}');
    const key = useOutbox.getState().messages[0]?.id ?? '';
    const chat = [entry({ id: key, seq: 1, who: 'operator', message: 'long ago' })];
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], chat })));
    const later = [entry({ id: 'later', seq: 200 })];
    act(() => useLive.getState().takeSnapshot(snapshot({ run: 'run-2', robots: [robot({ name: 'Ada' })], chat: later, chat_complete: false })));
    expect(screen.queryByText('long ago')).toBeNull();
    expect(screen.queryByText('Sending…')).toBeNull();
  });

  it('keeps a draft for each robot', async () => {
    const user = show({});
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'half a sen');
    await user.click(tab('Bob'));
    expect(screen.getByRole('textbox', { name: 'Write to Bob' })).toHaveProperty('value', '');
    await user.click(tab('Ada'));
    expect(screen.getByRole('textbox', { name: 'Write to Ada' })).toHaveProperty('value', 'half a sen');
  });

  it('marks the next message as the answer to an open question', async () => {
    const question = entry({ id: 'q', seq: 1, type: 'request', message: 'Which door?', question: 'open', choices: ['red', 'blue'] });
    const user = show({ chat: [question] });
    expect(tab('Ada').textContent).toContain('waiting for your answer');
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'the green one{Enter}');
    await user.click(screen.getByRole('button', { name: 'Blue' }));
    expect(sent).toMatchObject([
      { text: 'the green one', reply_to: 'q' },
      { text: 'blue', reply_to: 'q', targets: ['Ada'] },
    ]);
  });

  it('keeps what a robot needs from a person beside where one writes, and marks its tab', async () => {
    const help = entry({ id: 'h', seq: 1, type: 'info', message: 'I am waiting here.', choices: ['try again', 'skip it'] });
    const noted = entry({ id: 'n', seq: 2, type: 'info', message: 'I noted something.', choices: ['Forget it'], targets: ['Bob'] });
    const question = entry({ id: 'q', seq: 3, type: 'request', message: 'Which door?', question: 'open', choices: ['red'], targets: ['Bob'] });
    const user = show({ chat: [help, noted, question], plans: [plan({ robot: 'Ada', state: 'held' })] });
    expect(tab('Ada').textContent).toContain('Ada is waiting for your answer');
    await user.click(within(screen.getByRole('region', { name: 'Ada asks' })).getByRole('button', { name: 'Skip it' }));
    expect(sent).toMatchObject([{ text: 'skip it', targets: ['Ada'], reply_to: 'h' }]);

    await user.click(tab('Bob'));
    const ask = screen.getByRole('region', { name: 'Bob asks' });
    expect(within(ask).getByText(/Which door/)).toBeTruthy();
    expect(within(ask).queryByRole('button', { name: 'Forget it' })).toBeNull(); // nobody waits for that
    expect(screen.getAllByRole('button', { name: 'Red' })).toHaveLength(1);
  });

  it('undoes by a tap what a robot concluded by itself', async () => {
    const noted = entry({ id: 'n', seq: 1, type: 'info', message: 'I noted for myself: “Kim likes tea”', choices: ['Forget “kim”'] });
    const user = show({ chat: [noted] });
    await user.click(screen.getByRole('button', { name: 'Forget “kim”' }));
    expect(sent).toMatchObject([{ text: 'Forget “kim”', reply_to: 'n', targets: ['Ada'] }]);
  });

  it('says which of several robots takes a message as an answer', async () => {
    const question = entry({ id: 'q', seq: 1, type: 'request', message: 'Which door?', question: 'open' });
    const user = show({ chat: [question] });
    await user.keyboard('{Shift>}');
    await user.click(tab('Bob'));
    await user.keyboard('{/Shift}');
    expect(screen.getByText('Ada gets this as the answer, Bob as a new request.')).toBeTruthy();
  });

  it('says when a message was not sent and sends the same one again', async () => {
    answers = [() => new Response(JSON.stringify({ title: 'no', detail: 'Too many messages.', remedy: 'Wait.' }), { status: 429 })];
    const user = show({ chat: [entry({ id: 'e', seq: 1 })] });
    await user.type(screen.getByRole('textbox', { name: 'Write to Ada' }), 'hello{Enter}');
    expect((await screen.findByRole('alert')).textContent).toContain('Not sent. Too many messages. Wait.');
    await user.click(screen.getByRole('button', { name: 'Send again' }));
    expect(sent).toHaveLength(2);
    expect(sent[1]).toEqual(sent[0]);
  });

  it('begins a new line with Shift and takes the last message again with the arrow', async () => {
    const user = show({ chat: [entry({ id: 'e', seq: 1, who: 'operator', message: 'go home' })] });
    const box = screen.getByRole('textbox', { name: 'Write to Ada' });
    await user.type(box, 'a{Shift>}{Enter}{/Shift}b');
    expect(box).toHaveProperty('value', 'a\nb');
    await user.clear(box);
    await user.type(box, '{ArrowUp}');
    expect(box).toHaveProperty('value', 'go home');
  });

  it('shows times and kinds only when asked to', async () => {
    show({ chat: [entry({ id: 'e', seq: 1, type: 'info', message: 'on my way' })] });
    expect(screen.queryByText('INFO')).toBeNull();
    act(() => usePrefs.setState({ debug: true }));
    expect(screen.getByText('INFO')).toBeTruthy();
  });

  it('is a few keys away from writing however much was said, and arrow keys lead to what was said before', async () => {
    const chat = Array.from({ length: 30 }, (_, index) => entry({ id: `e${index}`, seq: index, who: 'operator', message: `order ${index}`, sources: ['box'] }));
    const user = show({ chat });
    const box = screen.getByRole('textbox', { name: 'Write to Ada' });
    let stops = 0;
    for (; document.activeElement !== box && stops < 60; stops += 1) await user.tab();
    expect(stops).toBeLessThan(15);
    for (let back = 0; back < 3; back += 1) await user.tab({ shift: true });
    await user.keyboard('{ArrowUp}');
    await user.tab();
    await user.tab();
    await user.keyboard('{Enter}');
    expect(box).toHaveProperty('value', 'order 28');
  });

  it('draws the newest part of a long conversation and more when asked', async () => {
    const chat = Array.from({ length: 100 }, (_, index) => entry({ id: `e${index}`, seq: index, message: `message ${index}` }));
    const user = show({ chat });
    expect(screen.queryByText('message 10')).toBeNull();
    expect(screen.getByText('message 99')).toBeTruthy();
    await user.click(screen.getByRole('button', { name: 'Show earlier messages' }));
    expect(screen.getByText('message 10')).toBeTruthy();
  });
});
