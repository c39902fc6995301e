import { render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import type { StopView } from '@/live/types';
import { useStopping } from '@/state/stopping';
import { StopButton } from '@/ui/stop-button';

import { StopBanner } from './stop-banner';

const sent: { command: string; targets: string[]; id: string }[] = [];
let reachable: boolean[] = [];

beforeEach(() => {
  sent.length = 0;
  reachable = [];
  useStopping.setState({ pending: null });
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    sent.push(JSON.parse(String(options.body)) as (typeof sent)[number]);
    return (reachable.shift() ?? true) ? Promise.resolve(new Response('{}')) : Promise.reject(new TypeError('no network'));
  });
});

const stop = (state: StopView['state']): StopView => ({ state, id: 's', sent_unix_ms: 1000, at_rest_unix_ms: 0 });

const show = (...states: StopView['state'][]) => {
  const robots = states.map((state, index) => robot({ name: ['Ada', 'Bob', 'Cleo'][index] ?? '', stop: stop(state) }));
  useLive.getState().takeSnapshot(snapshot({ robots }));
  render(
    <>
      <StopButton />
      <StopBanner />
    </>,
  );
  return userEvent.setup();
};

describe('stopping', () => {
  it('stops all robots with one click', async () => {
    const user = show('none', 'none');
    await user.click(screen.getByRole('button', { name: 'Stop all' }));
    expect(sent).toMatchObject([{ command: 'stop', targets: [] }]);
  });

  it('stops one of several', async () => {
    const user = show('none', 'none');
    await user.click(screen.getByRole('button', { name: 'Which robots to stop' }));
    await user.click(screen.getByRole('menuitem', { name: 'Stop only Bob' }));
    expect(sent).toMatchObject([{ command: 'stop', targets: ['Bob'] }]);
  });

  it('tries the same stop again until it gets through, and says so', async () => {
    reachable = [false];
    const user = show('none');
    await user.click(screen.getByRole('button', { name: 'Stop' }));
    await screen.findByText(/has not got through yet/);
    await waitFor(() => expect(sent).toHaveLength(2), { timeout: 3000 });
    expect(sent[1]).toEqual(sent[0]);
    await waitFor(() => expect(screen.queryByText(/has not got through yet/)).toBeNull());
  });

  it('tells sent, received and standing still apart', () => {
    show('received');
    const reached = screen.getAllByRole('listitem').filter((item) => item.dataset.reached === 'true');
    expect(reached.map((item) => item.textContent?.replace(/\d.*/, ''))).toEqual(['Sent', 'Ada knows']);
  });

  it('warns when standing still was not confirmed', () => {
    show('overdue');
    expect(screen.getByText(/Not confirmed/)).toBeTruthy();
  });

  it('tells of many in one line, and of each when wanted', async () => {
    const user = show('at_rest', 'overdue', 'received');
    screen.getByText(/^3 robots are stopped/);
    screen.getByText('Standing still: 1 of 3');
    screen.getByText(/^Not confirmed: Bob!/);
    expect(screen.queryByText(/^Ada is stopped/)).toBeNull();
    await user.click(screen.getByRole('button', { name: 'Each of them' }));
    expect(screen.getAllByText(/ is stopped and stays so/)).toHaveLength(3);
  });

  it('releases many at once after a second yes that names them', async () => {
    const user = show('at_rest', 'at_rest', 'at_rest');
    await user.click(screen.getByRole('button', { name: 'Release all…' }));
    screen.getByText(/Ada, Bob,? and Cleo/);
    expect(sent).toEqual([]);
    await user.click(screen.getByRole('button', { name: 'Yes, it is safe' }));
    expect(sent).toMatchObject([{ command: 'reset', targets: ['Ada', 'Bob', 'Cleo'] }]);
  });

  it('releases a robot only after a second yes', async () => {
    const user = show('at_rest');
    await user.click(screen.getByRole('button', { name: 'Release…' }));
    expect(sent).toEqual([]);
    await user.click(screen.getByRole('button', { name: 'Yes, it is safe' }));
    expect(sent).toMatchObject([{ command: 'reset', targets: ['Ada'] }]);
  });
});
