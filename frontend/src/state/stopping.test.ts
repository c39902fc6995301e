import { afterEach, expect, it, vi } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { useStopping } from './stopping';

const leaving = () => window.dispatchEvent(new Event('beforeunload', { cancelable: true }));

afterEach(() => useStopping.getState().callOff());

it('a stop outlives the page that sent it, and nobody closes the page unasked before it is taken', () => {
  const sent: RequestInit[] = [];
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    sent.push(options);
    return new Promise(() => undefined);
  });
  void useStopping.getState().stop(['Ada']);
  expect(sent).toMatchObject([{ method: 'POST', keepalive: true }]);
  expect(leaving()).toBe(false);
  useStopping.getState().callOff();
  expect(leaving()).toBe(true);
});

it('what became of a stop is not told any more once it was released, however late that is heard', async () => {
  const body = (options: RequestInit) => JSON.parse(String(options.body)) as { command: string; id: string };
  const answers: (() => void)[] = [];
  const stopped = (id: string) => new Response(JSON.stringify({ ok: true, kept: true, id, robots: { Ada: 'stands' } }));
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    const { command, id } = body(options);
    return command === 'reset' ? Promise.resolve(stopped(id)) : new Promise((settle) => answers.push(() => settle(stopped(id))));
  });
  const first = useStopping.getState().stop(['Ada']);
  await useStopping.getState().reset(['Ada']);
  answers[0]?.();
  await first;
  expect(useStopping.getState().answer).toBeNull();
  const second = useStopping.getState().stop(['Ada']); // this one holds
  answers[1]?.();
  await second;
  expect(useStopping.getState().answer?.robots).toEqual({ Ada: 'stands' });
});

it('what became of a stop is not told any more once somebody else released it', async () => {
  const answer = (id: string) => new Response(JSON.stringify({ ok: true, kept: true, id, robots: { Ada: 'moves', Bob: 'stands' } }));
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => Promise.resolve(answer((JSON.parse(String(options.body)) as { id: string }).id)));
  const fare = (state: 'stopped' | 'idle', name: string) => robot({ name, state });
  const show = (...robots: ReturnType<typeof robot>[]) => useLive.getState().takeSnapshot(snapshot({ robots }));
  show(fare('idle', 'Ada'), fare('idle', 'Bob'));
  await useStopping.getState().stop([]);
  show(fare('stopped', 'Ada'), fare('stopped', 'Bob'));
  show(fare('idle', 'Ada'), fare('stopped', 'Bob'));
  expect(useStopping.getState().answer?.robots).toEqual({ Bob: 'stands' });
});
