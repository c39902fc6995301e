import { act, renderHook } from '@testing-library/react';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';

import { entry, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useToasts } from '@/state/toasts';

import { LEAST_MS, MOST_MS, useNotices } from './use-notices';

const shown = () => useToasts.getState().toasts.map((toast) => toast.message);
const ada = (seq: number, state: 'idle' | 'running', battery = 1) => ({ kind: 'robot' as const, seq, robot: robot({ name: 'Ada', state, battery }) });
const refused = (seq: number) => ({ kind: 'rejection' as const, seq, robot: 'Ada', message: 'Ada cannot do that.' });

beforeEach(() => useToasts.setState({ toasts: [] }));
afterEach(() => vi.useRealTimers());

it.each([
  ['it is released', 0, { name: 'Ada' }],
  ['it could be read: it stands at the top of the page all the time', MOST_MS, { name: 'Ada', battery: 0.4, state: 'stopped' as const }],
])('takes back that a stopped robot does not move, as soon as %s', (_, afterMs, next) => {
  vi.useFakeTimers();
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', state: 'stopped' })] }));
  renderHook(useNotices);
  act(() => useLive.getState().takeChanges([{ kind: 'rejection', seq: 1, robot: 'Ada', message: 'Ada does not move.' }]));
  expect(shown()).toEqual(['Ada does not move.']);
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 2, robot: robot({ name: 'Ada', battery: 0.5, state: 'stopped' }) }]));
  expect(shown()).toHaveLength(1);
  vi.advanceTimersByTime(afterMs);
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 3, robot: robot(next) }]));
  expect(shown()).toEqual([]);
});

it.each([
  ['works again', ada(3, 'running')],
  ['is told something else', { kind: 'chat' as const, seq: 3, entry: entry({ id: 'next', seq: 3, who: 'operator', targets: ['Ada'] }) }],
])('takes back what was refused once the robot %s, when it could be read', (_, next) => {
  vi.useFakeTimers();
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', state: 'idle' })] }));
  renderHook(useNotices);
  act(() => useLive.getState().takeChanges([refused(1)]));
  act(() => useLive.getState().takeChanges([ada(2, 'idle', 0.5)]));
  act(() => useLive.getState().takeChanges([next]));
  expect(shown()).toEqual(['Ada cannot do that.']);
  act(() => vi.advanceTimersByTime(LEAST_MS));
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 4, robot: robot({ name: 'Bob' }) }]));
  expect(shown()).toEqual([]);
});

it('shows what is refused after the server was started anew', () => {
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
  renderHook(useNotices);
  act(() => useLive.getState().takeChanges([refused(50)]));
  act(() => useToasts.setState({ toasts: [] }));
  act(() => useLive.getState().takeSnapshot(snapshot({ run: 'another', robots: [robot({ name: 'Ada' })] })));
  act(() => useLive.getState().takeChanges([refused(2)]));
  expect(shown()).toEqual(['Ada cannot do that.']);
});
