/** Rooms and things that people put on the map, as they are being drawn. Plain functions; metres in the map. */
import type { MapRoom, MapThing } from '@/live/types';
import { outline, type Corner } from '@/ui/corners';

import { nameOf, type Mark } from './marks';

export type Named = MapRoom | MapThing;

export interface Draft {
  kind: 'room' | 'thing';
  /** As it is on the map; null: it is new. */
  was: Named | null;
  name: string;
  /** Of a room around it, two of a rectangle; of a thing where it is, and where a robot stands for it. */
  corners: readonly Corner[];
  /** Nothing was drawn yet: what is drawn takes the place of what is there. */
  fresh: boolean;
}

export const isRoom = (named: Named): named is MapRoom => 'corners' in named;
export const labelOf = (named: Named): string => (isRoom(named) ? named.name : nameOf(named));

export const newDraft = (kind: Draft['kind']): Draft => ({ kind, was: null, name: '', corners: [], fresh: false });

/** What is picked out, to be changed; null: a bare place. */
export function draftOf(mark: Mark): Draft | null {
  if (mark.kind === 'room') return { kind: 'room', was: mark.room, name: mark.room.name, corners: mark.room.corners, fresh: true };
  if (mark.kind !== 'thing') return null;
  const { thing } = mark;
  const stand: Corner[] = thing.stand && !isAt(thing, thing.stand) ? [[thing.stand.x, thing.stand.y]] : [];
  return { kind: 'thing', was: thing, name: nameOf(thing), corners: [[thing.x, thing.y], ...stand], fresh: true };
}

const isAt = (one: { x: number; y: number }, other: { x: number; y: number }) => Math.hypot(one.x - other.x, one.y - other.y) < 0.01;

/** What the map shows of it. */
export function shownOf({ kind, corners }: Draft): readonly Corner[] {
  const [at, stand] = corners;
  return kind === 'thing' && at && stand ? [at, stand, at] : corners;
}

/**
 * After a tap or a drag.
 * @param next What was shown and one corner more, or two of their own after a drag.
 */
export function drawn(draft: Draft, next: readonly Corner[]): Draft {
  const before = shownOf(draft);
  const tapped = next.length === before.length + 1 && before.every((corner, index) => corner === next[index]) ? next.at(-1) : undefined;
  const kept = draft.fresh ? [] : draft.corners;
  const first = kept[0];
  if (!tapped) return { ...draft, corners: next.slice(0, 2), fresh: false };
  const corners = draft.kind === 'thing' && first ? [first, tapped] : [...kept, tapped];
  return { ...draft, corners, fresh: false };
}

/** Whether it could be put on the map. */
export const isWhole = ({ kind, corners, name }: Draft): boolean => name.trim() !== '' && corners.length >= (kind === 'room' ? 2 : 1);

/** As it is to be on the map. */
export function putOf(draft: Draft): Named {
  const name = draft.name.trim();
  if (draft.kind === 'room') return { name, corners: outline(draft.corners).map(([x, y]) => [x, y]) };
  const thing = draft.was && !isRoom(draft.was) ? draft.was : nothing;
  const [[x, y] = [0, 0], stand] = draft.corners;
  const kept = draft.fresh ? (thing.stand ?? null) : thing.stand && isAt(thing, thing.stand) ? { ...thing.stand, x, y } : null;
  const chosen = stand && !draft.fresh ? { x: stand[0], y: stand[1], yaw: Math.atan2(y - stand[1], x - stand[0]) } : kept;
  return { ...thing, description: name, x, y, stand: chosen, found: false };
}

const nothing: MapThing = { id: '', kind: 'place', description: '', x: 0, y: 0, width: 0, height: 0, aliases: [], front: null, stand: null, found: false };

/** Another one in the place of `same`, which has its name already. */
export function movedHere(same: Named, put: Named): Named {
  if (isRoom(same) || isRoom(put)) return put;
  return { ...same, x: put.x, y: put.y, stand: put.stand ?? null, found: false };
}

/** Whether one can be moved to where the other is drawn. */
export const isSameKind = (one: Named, other: Named): boolean => isRoom(one) === isRoom(other);
