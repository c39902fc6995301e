import { useRef, useState, type PointerEvent } from 'react';

import type { MapInfo, Rule } from '@/live/types';

import { cornersOf, outline, type Corner } from './corners';
import { bounds } from './map-bounds';
import css from './zone-map.module.css';

interface Props {
  map: MapInfo;
  rules: readonly Rule[];
  /** What is being drawn. */
  draft?: readonly Corner[];
  /** The way of a plan that was tried. */
  way?: readonly Corner[];
  onDraw?: (corners: Corner[]) => void;
}

const DRAG_M = 0.15;
const points = (corners: readonly Corner[]) => corners.map(([x, y]) => `${x},${y}`).join(' ');

/** The map with its zones, to look at and to draw on; whoever cannot see it writes the corners. */
export function ZoneMap({ map, rules, draft = [], way = [], onDraw }: Props) {
  const inside = useRef<SVGGElement>(null);
  const [from, setFrom] = useState<Corner | null>(null);
  const { from: low, to: high } = bounds(map);
  const at = (event: PointerEvent): Corner => {
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(inside.current?.getScreenCTM()?.inverse());
    return [place.x, place.y];
  };
  const far = (corner: Corner) => from !== null && Math.hypot(corner[0] - from[0], corner[1] - from[1]) > DRAG_M;
  const move = (event: PointerEvent) => {
    const here = at(event);
    if (from && onDraw && far(here)) onDraw([from, here]);
  };
  const end = (event: PointerEvent) => {
    const here = at(event);
    if (from && onDraw && !far(here)) onDraw([...draft, here]);
    setFrom(null);
  };
  const drawn = onDraw && { onPointerDown: (event: PointerEvent) => setFrom(at(event)), onPointerMove: move, onPointerUp: end };
  return (
    <svg
      className={css.map}
      data-drawn={onDraw !== undefined}
      viewBox={`${low.x} ${-high.y} ${high.x - low.x} ${high.y - low.y}`}
      aria-hidden="true"
      {...drawn}
    >
      <g ref={inside} transform="scale(1 -1)">
        <image
          href={`data:image/png;base64,${map.image}`}
          width={map.width}
          height={map.height}
          transform={`translate(${map.origin.x} ${map.origin.y}) translate(0 ${map.height * map.resolution}) scale(${map.resolution} ${-map.resolution})`}
        />
        {map.objects.map((thing) => (
          <rect key={thing.id} className={css.thing} x={thing.x - thing.width / 2} y={thing.y - thing.height / 2} width={thing.width} height={thing.height} />
        ))}
        {rules.map((rule) => (
          <polygon key={rule.id} className={css.zone} data-kind={rule.kind} points={points(outline(cornersOf(rule)))} />
        ))}
        {draft.length > 0 && <polygon className={css.draft} points={points(outline(draft))} />}
        {draft.map(([x, y], index) => (
          <circle key={index} className={css.corner} cx={x} cy={y} r={0.08} />
        ))}
        {way.length > 1 && <polyline className={css.way} points={points(way)} />}
      </g>
    </svg>
  );
}
