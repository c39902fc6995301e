import { act, render, screen } from '@testing-library/react';
import { expect, it } from 'vitest';

import { mission, missionPart, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import type { PlanView } from '@/live/types';

import { PlanPanel } from './plan-panel';

it('shows what was done together last only until the robot does something else', () => {
  const past = mission({ id: 'm', words: 'check all doors', parts: [missionPart({ robot: 'Ada', order: 'a', state: 'done' })] });
  const told = (state: PlanView['state'], of: PlanView['steps'][number]['state']) => {
    const plans = [plan({ robot: 'Ada', state, steps: [step({ id: 'a', label: 'Go', state: of })] })];
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], plans, missions: [past] })));
  };
  told('ended', 'finished');
  render(<PlanPanel />);
  expect(screen.queryByText(/check all doors/)).not.toBeNull();
  told('running', 'running');
  expect(screen.queryByText(/check all doors/)).toBeNull();
});
