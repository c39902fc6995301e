import type { MapThing } from '@/live/types';

import { toScreen, type Size, type Viewport } from './viewport';
import css from './places.module.css';

const DOT_PX = 5;
const SMALL_M = 0.05;

/** What has no size on the map, and where robots stand for things. */
export function PlaceMarks({ things, marked, view, size }: { things: readonly MapThing[]; marked: MapThing | null; view: Viewport; size: Size }) {
  return (
    <g className={css.marks}>
      {things.map((thing) => {
        const at = toScreen(view, size, thing);
        const stand = thing === marked && thing.stand ? toScreen(view, size, thing.stand) : null;
        const isSmall = thing.width < SMALL_M && thing.height < SMALL_M;
        return (
          <g key={thing.id} data-found={thing.found} data-marked={thing === marked}>
            {stand && <line x1={at.x} y1={at.y} x2={stand.x} y2={stand.y} />}
            {stand && <circle cx={stand.x} cy={stand.y} r={DOT_PX} data-stand />}
            {isSmall && <circle cx={at.x} cy={at.y} r={DOT_PX} />}
          </g>
        );
      })}
    </g>
  );
}
