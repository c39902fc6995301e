import { expect, it } from 'vitest';

import { mapView } from '@/live/samples';

import { withViews, type Trails } from './use-trails';

const at = (actor: string, x: number) => ({ ...mapView, actor, pose: { x, y: 0, yaw: 0 } });

it('keeps where each robot was, not where it merely trembled', () => {
  const first = withViews({}, [at('Ada', 0), at('Bob', 5)]);
  expect(withViews(first, [at('Ada', 0.1), at('Bob', 5)])).toBe(first);
  expect(withViews(first, [at('Ada', 0.2), at('Bob', 5)])).toEqual({ Ada: [[0, 0], [0.2, 0]], Bob: [[5, 0]] });
});

it('forgets the oldest of a long way', () => {
  let trails: Trails = {};
  for (let x = 0; x < 500; x += 1) trails = withViews(trails, [at('Ada', x / 2)]);
  expect(trails['Ada']?.[0]).toEqual([50, 0]);
});

it('draws no way where a robot was put elsewhere, as after a restart', () => {
  expect(withViews({ Ada: [[0, 0], [1, 0]] }, [at('Ada', 3)])).toEqual({ Ada: [[3, 0]] });
});
