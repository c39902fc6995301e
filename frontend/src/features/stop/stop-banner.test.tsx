import { act, cleanup, fireEvent, render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import type { StopAnswer, StopView } from '@/live/types';
import { useStopping } from '@/state/stopping';
import { StopButton } from '@/ui/stop-button';

import { StopBanner } from './stop-banner';

const sent: { command: string; targets: string[]; id: string }[] = [];
let reachable: boolean[] = [];

let robots: StopAnswer['robots'] = {};

beforeEach(() => {
  sent.length = 0;
  reachable = [];
  robots = {};
  useStopping.setState({ pending: null, answer: null });
  useLive.setState({ connection: 'connected' });
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    const body = JSON.parse(String(options.body)) as (typeof sent)[number];
    sent.push(body);
    const answer = JSON.stringify({ ok: true, kept: true, id: body.id, robots } satisfies StopAnswer);
    return (reachable.shift() ?? true) ? Promise.resolve(new Response(answer)) : Promise.reject(new TypeError('no network'));
  });
});

afterEach(() => {
  vi.useRealTimers();
  vi.restoreAllMocks();
});

/** As on a large screen. */
const withRoom = () => {
  const matches = (query: string) => !query.includes('max-height');
  vi.spyOn(window, 'matchMedia').mockImplementation((query) => Object.assign(new EventTarget(), { matches: matches(query), media: query }) as MediaQueryList);
};

const stop = (state: StopView['state'], release: StopView['release'] = 'none'): StopView => ({
  state,
  id: 's',
  sent_unix_ms: 1000,
  at_rest_unix_ms: 0,
  release,
});

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

it('says which robot somebody has to go and look after, and no more once it is well', () => {
  const ada = robot({ name: 'Ada', trouble: 'pressed' });
  const bob = robot({ name: 'Bob', trouble: 'silent' });
  act(() => useLive.getState().takeSnapshot(snapshot({ robots: [ada, bob] })));
  render(<StopBanner />);
  screen.getByText(/button on Ada itself is pressed/);
  screen.getByText(/base of Bob does not answer/);
  act(() => useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), { ...bob, trouble: '' }] })));
  expect(screen.queryByText(/is pressed|does not answer/)).toBeNull();
});

it('says of a robot that was lost while it may have been driving that somebody has to go and look', () => {
  const gone = { connection: 'lost', state: 'running' } as const;
  const robots = [robot({ ...gone, name: 'Ada' }), robot({ ...gone, name: 'Bob', state: 'idle', at_rest: true })];
  act(() => useLive.getState().takeSnapshot(snapshot({ robots })));
  render(<StopBanner />);
  screen.getByText(/^Ada does not answer/);
  expect(screen.queryByText(/Bob/)).toBeNull();
});

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

  it('takes two clicks in a row for one stop', async () => {
    reachable = [false, false];
    const user = show('none');
    await user.dblClick(screen.getByRole('button', { name: 'Stop' }));
    expect(new Set(sent.map((post) => post.id)).size).toBe(1);
  });

  it('tries the same stop again until it gets through, and says so', async () => {
    reachable = [false];
    const user = show('none');
    await user.click(screen.getByRole('button', { name: 'Stop' }));
    await screen.findByText(/has not got through!/);
    await waitFor(() => expect(sent).toHaveLength(2), { timeout: 3000 });
    expect(sent[1]).toEqual(sent[0]);
    await waitFor(() => expect(screen.queryByText(/has not got through!/)).toBeNull());
  });

  it('says at once that there is no connection, and sends the stop until it gets through or is called off', async () => {
    vi.useFakeTimers();
    useLive.setState({ connection: 'lost' });
    reachable = Array<boolean>(120).fill(false);
    show('none');
    fireEvent.click(screen.getByRole('button', { name: 'Stop' }));
    screen.getByText(/^Not connected:/);
    await act(() => vi.advanceTimersByTimeAsync(30_000));
    screen.getByText(/^Not connected:/);
    const tried = sent.length;
    expect(tried).toBeGreaterThan(30);
    expect(new Set(sent.map((post) => post.id)).size).toBe(1);
    fireEvent.click(screen.getByRole('button', { name: 'Call it off' }));
    expect(screen.queryByText(/^Not connected:/)).toBeNull();
    await act(() => vi.advanceTimersByTimeAsync(10_000));
    expect(sent.length).toBeLessThanOrEqual(tried + 1);
  });

  it('tells of two in one line where there is little room, and of each where there is more', () => {
    show('at_rest', 'at_rest');
    screen.getByText(/^2 robots are stopped/);
    screen.getByRole('button', { name: 'Release all…' });
    cleanup();
    withRoom();
    show('at_rest', 'at_rest');
    expect(screen.getAllByText(/ is stopped and stays so/)).toHaveLength(2);
  });

  it('says of each robot what the stop was answered, before the live stream does', async () => {
    withRoom();
    robots = { Ada: 'stands', Bob: 'moves' };
    const user = show('none', 'none');
    await user.click(screen.getByRole('button', { name: 'Stop all' }));
    await screen.findByText('Stands still (measured)');
    screen.getByText(/^Bob does not stand still!/);
  });

  it.each([
    ['sent', /not known yet/],
    ['received', /not known yet/],
    ['at_rest', /measured/],
    ['moves', /^Ada does not stand still!/],
    ['silent', /^Ada does not answer!/],
  ] as const)('tells %s in plain words', (state, words) => {
    show(state);
    screen.getByText(words);
  });

  it('tells of many in one line, and of each when wanted', async () => {
    const user = show('at_rest', 'silent', 'moves');
    screen.getByText(/^3 robots are stopped/);
    screen.getByText('Standing still: 1 of 3');
    screen.getByText(/^No answer: Bob!/);
    screen.getByText(/^Not standing still: Cleo!/);
    expect(screen.queryByText(/^Ada is stopped/)).toBeNull();
    await user.click(screen.getByRole('button', { name: 'Each of them' }));
    expect(screen.getAllByText(/ is stopped and stays so/)).toHaveLength(3);
  });

  it('says that a release has not been heard, and that it was in vain', () => {
    show('at_rest');
    const ada = (release: StopView['release']) => [robot({ name: 'Ada', stop: stop('at_rest', release) })];
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: ada('sent') })));
    screen.getByText(/^Released, but not heard yet: Ada/);
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: ada('lost') })));
    screen.getByText(/^The release has not reached Ada/);
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
