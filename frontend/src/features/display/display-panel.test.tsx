import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import type { FeedInfo } from '@/live/types';

import { DisplayPanel } from './display-panel';
import { byRobot, isStale, useFeedChoice } from './shown-feeds';

const feed = (name: string, continuous = true, of = 'Ada'): FeedInfo => ({ robot: of, name, continuous, width: 0, height: 0, last_unix_ms: 0 });

beforeEach(() => {
  useFeedChoice.setState({ choice: {} });
});

const show = (...feeds: FeedInfo[]) => {
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], feeds }));
  render(<DisplayPanel />);
  return userEvent.setup();
};

const shown = () => screen.queryAllByRole('listitem').map((item) => item.querySelector('figcaption')?.textContent);

describe('the panel of pictures', () => {
  it('shows by itself what becomes active, but not the map, which has a panel of its own', () => {
    show(feed('camera'), feed('map'), feed('inspection', false));
    expect(shown()).toEqual(['Ada Camera', 'Ada A closer look']);
  });

  it('shows what is picked, grouped by robot, and remembers it', async () => {
    const user = show(feed('camera'), feed('map'), feed('camera', true, 'Bob'));
    await user.click(screen.getByRole('button', { name: 'Choose' }));
    await user.click(screen.getByRole('checkbox', { name: 'Map' }));
    const group = screen.getByRole('group', { name: 'Bob' });
    await user.click(group.querySelector('input') as HTMLInputElement);
    await user.keyboard('{Escape}');
    expect(shown()).toEqual(['Ada Camera', 'Ada Map']);
    expect(localStorage.getItem('parley.feeds')).toContain('Bob');
  });

  it('says so when everything is hidden', async () => {
    const user = show(feed('camera'));
    await user.click(screen.getByRole('button', { name: 'Choose' }));
    await user.click(screen.getByRole('button', { name: 'Hide all' }));
    await user.keyboard('{Escape}');
    screen.getByText('No pictures are chosen');
  });
});

describe('feeds', () => {
  it('are stale when they should follow and do not; single pictures never', () => {
    expect(isStale(feed('camera'), 10_000)).toBe(true);
    expect(isStale(feed('camera'), 500)).toBe(false);
    expect(isStale(feed('inspection', false), 10_000_000)).toBe(false);
  });

  it('are in order, by robot, those of a robot that is spoken to first', () => {
    const feeds = { a: feed('map'), b: feed('camera', true, 'Bob'), c: feed('camera') };
    expect(byRobot(feeds, ['Bob']).map(([name]) => name)).toEqual(['Bob', 'Ada']);
    const groups = byRobot(feeds, []);
    expect(groups.map(([name, feeds]) => [name, feeds.map((one) => one.name)])).toEqual([
      ['Ada', ['camera', 'map']],
      ['Bob', ['camera']],
    ]);
  });
});
