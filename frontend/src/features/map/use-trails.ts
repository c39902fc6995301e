import { useEffect, useState } from 'react';

import { useWorld } from '@/live/store';
import type { MapView } from '@/live/types';

type Point = readonly [number, number];

/** Where each robot of a map has been since this page shows it, oldest first. */
export type Trails = Readonly<Record<string, readonly Point[]>>;

const STEP_M = 0.15;
const KEPT = 400;
/** Farther than it drives between two views: it was put there, or nobody saw how it came there. */
const JUMP_M = 1;

/** The trails with what is known now; the same ones if no robot has moved far enough. */
export function withViews(trails: Trails, views: readonly MapView[]): Trails {
  const moved = views.filter(({ actor, pose }) => {
    const [x, y] = trails[actor]?.at(-1) ?? [Infinity, Infinity];
    return !(Math.hypot(pose.x - x, pose.y - y) < STEP_M);
  });
  if (moved.length === 0) return trails;
  const longer = moved.map(({ actor, pose }) => {
    const trail = trails[actor] ?? [];
    const [x, y] = trail.at(-1) ?? [Infinity, Infinity];
    const jumped = Math.hypot(pose.x - x, pose.y - y) > JUMP_M;
    return [actor, [...(jumped ? [] : trail), [pose.x, pose.y] as const].slice(-KEPT)] as const;
  });
  return { ...trails, ...Object.fromEntries(longer) };
}

export function useTrails(mapName: string): Trails {
  const views = useWorld((world) => world.views);
  const [trails, setTrails] = useState<Trails>({});
  useEffect(() => {
    const here = Object.values(views).filter((view) => view.map_name === mapName);
    // eslint-disable-next-line react-hooks/set-state-in-effect -- what was is not derived from what is
    setTrails((before) => withViews(before, here));
  }, [views, mapName]);
  return trails;
}
