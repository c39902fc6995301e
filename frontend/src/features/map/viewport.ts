/** What part of a map is on the screen. Plain functions; metres in the map, pixels on the screen. */
import type { MapInfo, MapThing } from '@/live/types';
import { bounds, type Place } from '@/ui/map-bounds';

export { roomAt, thingAt } from '@/ui/map-places';
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

/** Half as thick as walls are drawn, and what keeps a name apart from them. */
const WALL_M = 0.06;
const FROM_WALL_PX = 3;

/** What corners enclose between the walls that stand on its edge, on the screen. */
export function boxOf(corners: readonly (readonly [number, number])[], view: Viewport, size: Size): Box {
  const places = corners.map(([x, y]) => toScreen(view, size, { x, y }));
  const xs = places.map(({ x }) => x);
  const ys = places.map(({ y }) => y);
  const wall = WALL_M * view.scale + FROM_WALL_PX;
  return { left: Math.min(...xs) + wall, right: Math.max(...xs) - wall, top: Math.min(...ys) + wall, bottom: Math.max(...ys) - wall };
}

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

export interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** A box around a point: half as wide to each side, and so high. */
export const around = (at: Place, half: number, high: number): Box => ({
  left: at.x - half,
  right: at.x + half,
  top: at.y - high / 2,
  bottom: at.y + high / 2,
});

/** Where a thing is on the screen. */
export function boxOfThing(thing: MapThing, view: Viewport, size: Size): Box {
  const { x, y } = toScreen(view, size, thing);
  return around({ x, y }, (thing.width / 2) * view.scale, thing.height * view.scale);
}

/** What things take up together: around that may be walls. */
export const extentOf = (boxes: readonly Box[]): Box => ({
  left: Math.min(...boxes.map(({ left }) => left)),
  right: Math.max(...boxes.map(({ right }) => right)),
  top: Math.min(...boxes.map(({ top }) => top)),
  bottom: Math.max(...boxes.map(({ bottom }) => bottom)),
});

/** The middle of a room's corners. */
export const middleOf = ({ corners }: { corners: readonly (readonly [number, number])[] }): Place => ({
  x: corners.reduce((sum, [x]) => sum + x, 0) / corners.length,
  y: corners.reduce((sum, [, y]) => sum + y, 0) / corners.length,
});
