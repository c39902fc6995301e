import { act, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { plan, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import type { AbilityView } from '@/live/types';
import { useDrafts } from '@/state/drafts';

import { RobotsPage } from './robots-page';

const looking: AbilityView = {
  name: 'LookAt',
  description: 'Look at something.',
  label: '',
  phrases: ['look at {thing}'],
  inputs: {},
  outputs: {},
  optional: [],
  effects: [],
  risk: 'none',
  kind: 'looks_and_speaks',
  capabilities: [],
  examples: [],
  duration_s: null,
  timeout_s: null,
};
const asked: Asked[] = [];

beforeEach(() => {
  asked.length = 0;
  useDrafts.setState({ drafts: {} });
  vi.stubGlobal('fetch', network({}, asked));
  const robots = [robot({ name: 'Ada', battery: 0.123, catalogue: [looking] }), robot({ name: 'Bob', connection: 'left' })];
  useLive.getState().takeSnapshot(snapshot({ robots }));
  render(<RobotsPage />);
});

describe('the page of robots', () => {
  it('says what a robot can do in plain words and begins to ask for it', async () => {
    const user = userEvent.setup();
    await user.click(screen.getByText(/What Ada can do/));
    screen.getByText('Look at something.');
    expect(screen.queryByText(/LookAt/)).toBeNull();
    await user.click(screen.getByRole('button', { name: 'Look at …' }));
    expect(useDrafts.getState().drafts.Ada?.text).toBe('Look at ');
  });

  it('does not call a robot free that waits for a person', () => {
    screen.getByText('Free');
    const waiting = snapshot({ robots: [robot({ name: 'Ada' })], plans: [plan({ robot: 'Ada', state: 'held' })] });
    act(() => useLive.getState().takeSnapshot(waiting));
    screen.getByText('Waiting for you');
    expect(screen.queryByText('Free')).toBeNull();
  });

  it('shows the battery where it is known', () => {
    expect(screen.getAllByText('12 %')).toHaveLength(1);
  });

  it('takes only a robot off the list that is not there', async () => {
    expect(screen.queryByRole('button', { name: /Take Ada/ })).toBeNull();
    await userEvent.setup().click(screen.getByRole('button', { name: 'Take Bob off the list' }));
    expect(asked).toMatchObject([{ method: 'DELETE', path: 'robots/Bob' }]);
  });
});
