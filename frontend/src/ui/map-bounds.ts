import type { MapInfo } from '@/live/types';

export interface Place {
  /** Map frame, metres. */
  x: number;
  y: number;
}

/** Corners of the map's picture in the map frame. */
export function bounds(map: MapInfo): { from: Place; to: Place } {
  const wide = map.width * map.resolution;
  const high = map.height * map.resolution;
  const yaw = map.origin.yaw ?? 0;
  const corners = [
    [0, 0],
    [wide, 0],
    [0, high],
    [wide, high],
  ].map(([x = 0, y = 0]) => ({
    x: map.origin.x + x * Math.cos(yaw) - y * Math.sin(yaw),
    y: map.origin.y + x * Math.sin(yaw) + y * Math.cos(yaw),
  }));
  const xs = corners.map((corner) => corner.x);
  const ys = corners.map((corner) => corner.y);
  return { from: { x: Math.min(...xs), y: Math.min(...ys) }, to: { x: Math.max(...xs), y: Math.max(...ys) } };
}
