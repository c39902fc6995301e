/** What is at a place of the map. Plain functions. */
import type { MapRoom, MapThing } from '@/live/types';

import type { Place } from './map-bounds';

/** The thing at a place, the smallest of several; those too small for a finger count a little around them too. */
export function thingAt(things: readonly MapThing[], place: Place, reachM: number): MapThing | null {
  const hit = things.filter(
    (thing) =>
      Math.abs(place.x - thing.x) <= Math.max(thing.width / 2, reachM) &&
      Math.abs(place.y - thing.y) <= Math.max(thing.height / 2, reachM),
  );
  return hit.reduce<MapThing | null>(
    (best, thing) => (!best || thing.width * thing.height < best.width * best.height ? thing : best),
    null,
  );
}

/** The room at a place, the smallest of several. */
export const roomAt = (rooms: readonly MapRoom[], place: Place): MapRoom | null =>
  rooms.filter((room) => isInside(room, place)).sort((a, b) => areaOf(a) - areaOf(b))[0] ?? null;

const edges = ({ corners }: MapRoom) => corners.map((corner, index) => [corner, corners[(index + 1) % corners.length] ?? corner] as const);
const areaOf = (room: MapRoom) => Math.abs(edges(room).reduce((sum, [[x, y], [u, v]]) => sum + x * v - u * y, 0)) / 2;
const isInside = (room: MapRoom, at: Place) =>
  edges(room).filter(([[x, y], [u, v]]) => y > at.y !== v > at.y && at.x < ((u - x) * (at.y - y)) / (v - y) + x).length % 2 === 1;
