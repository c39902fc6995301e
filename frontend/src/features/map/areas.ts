/** Areas that are drawn on the map to become rules. Plain functions. */
import type { MapInfo } from '@/live/types';
import { around, type Corner } from '@/ui/corners';

import { nameOf, type Mark } from './marks';
import { middleOf, roomAt } from './viewport';

export interface Area {
  corners: readonly Corner[];
  /** What it would be called. */
  name: string;
}

/** The whole room or thing that is picked out; of a bare place nothing. */
export function areaOfMark(mark: Mark): Area {
  if (mark.kind === 'room') return { corners: mark.room.corners, name: mark.room.name };
  return mark.kind === 'thing' ? { corners: around(mark.thing), name: nameOf(mark.thing) } : { corners: [], name: '' };
}

/** The room in which the middle of an area lies; empty: none. */
export const roomOf = (map: MapInfo, corners: readonly Corner[]): string =>
  corners.length > 1 ? (roomAt(map.rooms, middleOf({ corners }))?.name ?? '') : '';
