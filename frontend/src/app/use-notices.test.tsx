import { act, renderHook } from '@testing-library/react';
import { expect, it } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useToasts } from '@/state/toasts';

import { useNotices } from './use-notices';

const shown = () => useToasts.getState().toasts.map((toast) => toast.message);

it('takes back that a stopped robot does not move, as soon as it is released', () => {
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', state: 'stopped' })] }));
  renderHook(useNotices);
  act(() => useLive.getState().takeChanges([{ kind: 'rejection', seq: 1, robot: 'Ada', message: 'Ada does not move.' }]));
  expect(shown()).toEqual(['Ada does not move.']);
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 2, robot: robot({ name: 'Ada', battery: 0.5, state: 'stopped' }) }]));
  expect(shown()).toHaveLength(1);
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 3, robot: robot({ name: 'Ada' }) }]));
  expect(shown()).toEqual([]);
});
