/** Which feeds are shown: what the person chose, and by itself what becomes active. */
import { create } from 'zustand';
import { createJSONStorage, persist } from 'zustand/middleware';

import type { FeedInfo } from '@/live/types';
import { feedKey } from '@/live/world';

/** Feed -> whether it was put in or taken out by hand. */
export type FeedChoice = Readonly<Record<string, boolean>>;

interface ChoiceState {
  choice: FeedChoice;
  choose: (feeds: readonly FeedInfo[], shown: boolean) => void;
}

/** The map has a panel of its own, so its picture comes only when somebody asks for it. */
const MAP_FEED = 'map';

export const useFeedChoice = create<ChoiceState>()(
  persist(
    (set) => ({
      choice: {},
      choose: (feeds, shown) =>
        set((now) => ({ choice: { ...now.choice, ...Object.fromEntries(feeds.map((feed) => [feedKey(feed), shown])) } })),
    }),
    { name: 'parley.feeds', version: 1, storage: createJSONStorage(() => localStorage) },
  ),
);

export const isShown = (feed: FeedInfo, choice: FeedChoice): boolean => choice[feedKey(feed)] ?? feed.name !== MAP_FEED;

/** All feeds by robot, those spoken to first; robots and feeds in alphabetical order. */
export function byRobot(feeds: Readonly<Record<string, FeedInfo>>, chosen: readonly string[]): [string, FeedInfo[]][] {
  const groups = new Map<string, FeedInfo[]>();
  const later = (feed: FeedInfo) => Number(!chosen.includes(feed.robot));
  const sorted = Object.values(feeds).sort((a, b) => later(a) - later(b) || a.robot.localeCompare(b.robot) || a.name.localeCompare(b.name));
  for (const feed of sorted) groups.set(feed.robot, [...(groups.get(feed.robot) ?? []), feed]);
  return [...groups];
}

const STALE_MS = 3000;

/** Whether a picture that should be live has stopped following. */
export const isStale = (feed: FeedInfo, ageMs: number): boolean => feed.continuous && ageMs > STALE_MS;
