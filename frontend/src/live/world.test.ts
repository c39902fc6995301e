import { describe, expect, it } from 'vitest';

import { entry, plan, robot, snapshot } from './samples';
import type { Change } from './types';
import { applyChanges, emptyWorld, fromSnapshot, mergeChat, planKey } from './world';

const ids = (chat: readonly { id: string }[]) => chat.map((one) => one.id);

describe('the world', () => {
  it('passes over changes that it already contains', () => {
    const world = fromSnapshot(snapshot({ seq: 5, robots: [robot({ name: 'Ada', state: 'running' })] }));
    const late: Change = { kind: 'robot', seq: 5, robot: robot({ name: 'Ada', state: 'idle' }) };
    expect(applyChanges(world, [late])).toBe(world);
  });

  it('takes the newest of several changes to one robot', () => {
    const changes: Change[] = [
      { kind: 'robot', seq: 1, robot: robot({ name: 'Ada', state: 'running' }) },
      { kind: 'robot', seq: 2, robot: robot({ name: 'Ada', state: 'paused' }) },
    ];
    const world = applyChanges(emptyWorld, changes);
    expect(world.robots['Ada']?.state).toBe('paused');
    expect(world.seq).toBe(2);
  });

  it('replaces a draft by the finished message in its place', () => {
    const world = applyChanges(emptyWorld, [
      { kind: 'chat', seq: 1, entry: entry({ id: 'a', seq: 1, message: 'I will', draft: true }) },
      { kind: 'chat', seq: 2, entry: entry({ id: 'b', seq: 2 }) },
      { kind: 'chat', seq: 3, entry: entry({ id: 'a', seq: 1, message: 'I will go' }) },
    ]);
    expect(ids(world.chat)).toEqual(['a', 'b']);
    expect(world.chat[0]).toMatchObject({ message: 'I will go', draft: false });
  });

  it('forgets plans and robots that are gone', () => {
    const before = fromSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], plans: [plan({ robot: 'Ada' })] }));
    const world = applyChanges(before, [
      { kind: 'plan_gone', seq: 1, robot: 'Ada', graph_name: 'plan_1' },
      { kind: 'robot_gone', seq: 2, name: 'Ada' },
    ]);
    expect(world.plans).toEqual({});
    expect(world.robots).toEqual({});
  });

  it('tells two graphs of one robot apart', () => {
    const world = fromSnapshot(
      snapshot({ plans: [plan({ robot: 'Ada' }), plan({ robot: 'Ada', graph_name: 'patrol', kind: 'graph' })] }),
    );
    expect(Object.keys(world.plans)).toEqual([
      planKey({ robot: 'Ada', graph_name: 'plan_1' }),
      planKey({ robot: 'Ada', graph_name: 'patrol' }),
    ]);
  });

  it('keeps earlier messages when the same run is told anew, but not across a gap', () => {
    const chat = [1, 2, 3].map((seq) => entry({ id: `e${seq}`, seq }));
    const before = fromSnapshot(snapshot({ chat }));
    const overlapping = fromSnapshot(
      snapshot({ chat: [entry({ id: 'e3', seq: 3 }), entry({ id: 'e4', seq: 4 })], chat_complete: false }),
      before,
    );
    expect(ids(overlapping.chat)).toEqual(['e1', 'e2', 'e3', 'e4']);
    const apart = fromSnapshot(snapshot({ chat: [entry({ id: 'e9', seq: 9 })], chat_complete: false }), before);
    expect(ids(apart.chat)).toEqual(['e9']);
    expect(apart.chatComplete).toBe(false);
  });

  it('knows that there is a gap behind an old question that is still open', () => {
    const chat = [entry({ id: 'q', seq: 2, question: 'open' }), entry({ id: 'e8', seq: 8 }), entry({ id: 'e9', seq: 9 })];
    const world = fromSnapshot(snapshot({ chat, chat_complete: false }));
    expect(world.chatFrom).toBe(8);
    const answered: Change = { kind: 'chat', seq: 1, entry: entry({ id: 'q', seq: 2, question: 'answered' }) };
    expect(applyChanges(world, [answered]).chatFrom).toBe(8);
  });

  it('begins anew when another run answers', () => {
    const before = fromSnapshot(snapshot({ chat: [entry({ id: 'old', seq: 1 })] }));
    const after = fromSnapshot(snapshot({ run: 'run-2', chat: [entry({ id: 'new', seq: 2 })] }), before);
    expect(ids(after.chat)).toEqual(['new']);
  });

  it('puts older messages in front, each once', () => {
    const chat = [entry({ id: 'c', seq: 3 }), entry({ id: 'd', seq: 4 })];
    const older = [entry({ id: 'a', seq: 1 }), entry({ id: 'b', seq: 2 }), entry({ id: 'c', seq: 3 })];
    expect(ids(mergeChat(chat, older))).toEqual(['a', 'b', 'c', 'd']);
  });
});
