import { act, render, screen } from '@testing-library/react';
import { expect, it, vi } from 'vitest';

import { entry, mapView, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';

import { RobotLine } from './robot-line';

it('says where a robot is and for how long it works on what it really does', () => {
  vi.useFakeTimers({ now: 100_000 });
  const place = [{ name: 'pose::position::x', type: 'number', value: null }];
  const finds = step({ id: 'a', state: 'running', only_finds: true, outputs: place, worked_ms: 5_000, working_since_unix_ms: 40_000 });
  const steps = [step({ id: 'look at it', state: 'finished' }), finds, step({ id: 'go to the door', inputs: place })];
  const views = [{ ...mapView, actor: 'Ada', room: 'hall' }];
  const working = robot({ name: 'Ada', state: 'running', battery: 0.915 });
  useLive.getState().takeSnapshot(snapshot({ robots: [working], views, plans: [plan({ robot: 'Ada', steps })] }));
  render(<RobotLine name="Ada" named />);
  const line = screen.getByRole('group', { name: 'How Ada fares' });
  expect([...line.querySelectorAll('p > :not([aria-hidden])')].map((one) => one.textContent)).toEqual(
    ['Ada', 'Working', 'Hall', '92 %', '2 of 2: Go to the door', '1:05'],
  );
  const far = { ...finds, only_finds: false, ends_unix_ms: 120_000 };
  act(() => useLive.getState().takeChanges([{ kind: 'plan', seq: 1, plan: plan({ robot: 'Ada', steps: [far] }) }]));
  expect(line.querySelector('time')?.textContent).toBe('0:20 to go');
  const asks = plan({ robot: 'Ada', steps: [step({ id: 'ask', state: 'waiting' })] });
  act(() => useLive.getState().takeChanges([{ kind: 'plan', seq: 2, plan: asks }]));
  expect(line.textContent).toMatch(/^AdaWaiting for you/);
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 3, robot: { ...working, state: 'stopped' } }]));
  expect(line.querySelector('time')).toBeNull();
  const which = entry({ id: 'w', seq: 4, type: 'response', message: 'Which box?', choices: ['red', 'blue'], targets: ['Ada'] });
  act(() => useLive.getState().takeChanges([{ kind: 'robot', seq: 4, robot: { ...working, state: 'idle' } }, { kind: 'chat', seq: 5, entry: which }]));
  expect(line.textContent).toMatch(/^AdaWaiting for you/);
  const left = { ...plan({ robot: 'Ada', steps: [step({ id: 'go to the gate' })] }), state: 'paused' as const };
  act(() => useLive.getState().takeSnapshot(snapshot({ robots: [{ ...working, state: 'idle' }], views: [{ ...mapView, actor: 'Ada', holds: 'red box' }], plans: [left] })));
  expect([...line.querySelectorAll('p > :not([aria-hidden])')].map((one) => one.textContent)).toEqual(
    ['Ada', 'Paused', 'Hall', 'Holds the red box', '92 %', '1 of 1: Go to the gate'], // after its program was started anew
  );
  act(() => useLive.getState().setConnection('lost', 1));
  expect(line.textContent).toBe('AdaNot known');
  vi.useRealTimers();
});
