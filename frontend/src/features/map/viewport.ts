/** What part of a map is on the screen. Plain functions; metres in the map, pixels on the screen. */
import type { MapInfo, MapThing } from '@/live/types';
import { bounds, type Place } from '@/ui/map-bounds';

export { bounds, type Place };

export interface Size {
  width: number;
  height: number;
}

export interface Viewport {
  /** What is in the middle of the screen, metres. */
  centre: Place;
  /** Pixels per metre. */
  scale: number;
}

const MARGIN_PX = 12;
const MAX_SCALE = 400;

/** The whole map, as large as there is room for. */
export function fit(map: MapInfo, size: Size): Viewport {
  const { from, to } = bounds(map);
  return {
    centre: { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2 },
    scale: Math.max(
      0.01,
      Math.min((size.width - 2 * MARGIN_PX) / (to.x - from.x), (size.height - 2 * MARGIN_PX) / (to.y - from.y)),
    ),
  };
}

export const toScreen = (view: Viewport, size: Size, place: Place): Place => ({
  x: size.width / 2 + (place.x - view.centre.x) * view.scale,
  y: size.height / 2 - (place.y - view.centre.y) * view.scale,
});

export const toMap = (view: Viewport, size: Size, point: Place): Place => ({
  x: view.centre.x + (point.x - size.width / 2) / view.scale,
  y: view.centre.y - (point.y - size.height / 2) / view.scale,
});

/** Larger or smaller around a point of the screen, which stays where it is. */
export function zoom(view: Viewport, size: Size, factor: number, at: Place, least: number): Viewport {
  const scale = Math.min(MAX_SCALE, Math.max(least, view.scale * factor));
  const fixed = toMap(view, size, at);
  return {
    scale,
    centre: {
      x: fixed.x - (at.x - size.width / 2) / scale,
      y: fixed.y + (at.y - size.height / 2) / scale,
    },
  };
}

/** Moved by so many pixels; some of the map always stays in view. */
export function pan(view: Viewport, map: MapInfo, dx: number, dy: number): Viewport {
  const { from, to } = bounds(map);
  const keep = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));
  return {
    scale: view.scale,
    centre: {
      x: keep(view.centre.x - dx / view.scale, from.x, to.x),
      y: keep(view.centre.y + dy / view.scale, from.y, to.y),
    },
  };
}

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

/** From so many pixels per metre there is room for more than what kind of thing it is. */
const LONG_NAMES_SCALE = 60;

/** What a thing is called on the map. */
export const labelOf = (thing: MapThing, scale: number): string =>
  (scale < LONG_NAMES_SCALE ? thing.kind || thing.description : thing.description || thing.kind).replaceAll('_', ' ');

const LETTER_PX = 6.6;
const LINE_PX = 16;

/** Which labels can be written inside the screen and not over each other; the first come first. */
export function roomForLabels(
  labels: readonly { id: string; text: string; at: Place }[],
  size: Size,
): ReadonlySet<string> {
  const taken: { left: number; right: number; top: number; bottom: number }[] = [];
  const written = new Set<string>();
  for (const { id, text, at } of labels) {
    const half = (text.length * LETTER_PX) / 2;
    const box = { left: at.x - half, right: at.x + half, top: at.y - LINE_PX / 2, bottom: at.y + LINE_PX / 2 };
    const inside = box.left >= 0 && box.right <= size.width && box.top >= 0 && box.bottom <= size.height;
    const free = inside && taken.every(
      (other) =>
        box.right < other.left || box.left > other.right || box.bottom < other.top || box.top > other.bottom,
    );
    if (!free) continue;
    taken.push(box);
    written.add(id);
  }
  return written;
}
