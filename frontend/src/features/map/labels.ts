/** Where names stand on a map: nearer to what they name than to anything else, and never over each other. */
import type { MapRoom, MapThing, Rule } from '@/live/types';
import { cornersOf, outline } from '@/ui/corners';
import type { Place } from '@/ui/map-bounds';

import { around, boxOf, middleOf, toScreen, type Box, type Size, type Viewport } from './viewport';

/** From so many pixels per metre there is room for what describes a thing; before that, for a name of so many letters. */
const DESCRIBING_SCALE = 60;
const NAME_LETTERS = 14;

/** Kind of what is nothing but a place with a name. */
const NAMED = 'place';

/**
 * What a thing may be called on the map, the best first: its own name, or else what kind of thing it is.
 * @param isOnly Whether nothing else is of its kind: of things with names the kind alone tells none from another.
 */
export const textsOf = ({ description, kind }: MapThing, scale: number, isOnly: boolean): readonly string[] => {
  const at = description.toLowerCase().indexOf(kind.toLowerCase());
  const written = at < 0 ? kind : description.slice(at, at + kind.length); // “TV” is “tv” among kinds
  const sort = kind === NAMED ? '' : written;
  const isName = !sort || description.length <= NAME_LETTERS || description.toLowerCase().endsWith(sort.toLowerCase());
  const named = isName || scale >= DESCRIBING_SCALE ? [description] : [];
  return [...named, ...(isName && description && !isOnly ? [] : [sort])].filter(Boolean).map((name) => name.replaceAll('_', ' '));
};

/** Parts of a room's width and depth. */
const PARTS = [0.5, 0.35, 0.65, 0.2, 0.8, 0.1, 0.9];
const ROOM_FOR_NAME_M = { x: 0.7, y: 0.15 };
const ROOM_LETTER_PX = 9.5;
const LETTER_PX = 6.5;
const ROBOT_LETTER_PX = 8;
const LINE_PX = 16;
const CLEAR_PX = 6;
const WIDE = /[mw@%]/gi;

export interface Label {
  id: string;
  /** What may be written, the best first. */
  texts: readonly string[];
  /** Where it would best stand. */
  at: Place;
  /** Where it may stand instead, the best first. */
  others?: readonly Place[];
  /** What it names, on the screen: it stands in that or beside it, never half over its edge. */
  names?: Box;
  /** Whether it stands in what it names or nowhere; its shortest words on what is smaller than they are, too. */
  isInside?: boolean;
  /** Wider than others. */
  letterPx?: number;
  /** What it stays in, but for shortest words that are wider than that; not given: the screen. */
  within?: Box | undefined;
}

/** What is written, and its middle. */
export interface Written extends Place {
  text: string;
}

const meet = (a: Box, b: Box) => a.right >= b.left && a.left <= b.right && a.bottom >= b.top && a.top <= b.bottom;
const isIn = (box: Box, outer: Box) => box.left >= outer.left && box.right <= outer.right && box.top >= outer.top && box.bottom <= outer.bottom;
const between = (low: number, value: number, high: number) => (low > high ? (low + high) / 2 : Math.min(high, Math.max(low, value)));

/** Whether words are so far from all other things that they are taken for the name of none, nor written over an edge. */
const isClear = (box: Box, things: readonly Box[], own: Box | undefined) =>
  things.every((thing) => thing === own || isIn(box, thing) || !meet(grown(box), thing));
const grown = ({ left, right, top, bottom }: Box): Box => ({ left: left - CLEAR_PX, right: right + CLEAR_PX, top: top - CLEAR_PX, bottom: bottom + CLEAR_PX });

/** Where words about a thing may stand: in it, below, above, right and left of it. */
function placesAt(thing: Box, half: number, isInside: boolean, isMark: boolean): readonly Place[] {
  const x = (thing.left + thing.right) / 2;
  const y = (thing.top + thing.bottom) / 2;
  const line = LINE_PX / 2 + 1;
  const inside = isMark || (thing.right - thing.left >= 2 * half && thing.bottom - thing.top >= LINE_PX) ? [{ x, y }] : [];
  if (isInside) return inside;
  const upright = [{ x, y: thing.bottom + line }, { x, y: thing.top - line }];
  return [...inside, ...upright, { x: thing.right + half + 3, y }, { x: thing.left - half - 3, y }];
}

/**
 * What can be written inside the screen and not over each other; the first come first, and all get their
 * shortest words before any gets longer ones.
 * @param marks What must not be written over: middle and radius.
 * @param things What words about other things must not stand on.
 */
export function roomForLabels(
  labels: readonly Label[],
  size: Size,
  marks: readonly { at: Place; radius: number }[] = [],
  things: readonly Box[] = [],
): ReadonlyMap<string, Written> {
  const screen = { left: 0, right: size.width, top: 0, bottom: size.height };
  const taken = new Map(marks.map(({ at, radius }, index) => [`mark ${index}`, around(at, radius, 2 * radius)]));
  const marked = new Set(taken.keys());
  const written = new Map<string, Written>();
  const write = ({ id, at, others = [], names, isInside = false, letterPx = LETTER_PX, within = screen }: Label, text: string, isShortest: boolean): boolean => {
    const half = ((text.length + (text.match(WIDE)?.length ?? 0) / 2) * letterPx) / 2;
    const kept = ({ x, y }: Place): Place => ({
      x: between(within.left + half, x, within.right - half),
      y: between(within.top + LINE_PX / 2, y, within.bottom - LINE_PX / 2),
    });
    const isMark = isInside && isShortest;
    const isFree = (box: Box) => !names || isMark || things.every((thing) => !meet(box, thing) || (thing === names && isIn(box, thing)));
    const fits = (box: Box) =>
      isIn(box, isShortest ? screen : within) && isIn(box, screen) && isFree(box) && [...taken].every(([other, its]) => other === id || (isMark && marked.has(other)) || !meet(box, its));
    const isSeen = isIn(around(at, 0, 0), screen); // else its name would stand at the edge
    const places = names ? placesAt(names, half, isInside, isMark) : [at, ...others];
    const free = isSeen ? places.map(kept).filter((one) => fits(around(one, half, LINE_PX))) : [];
    const place = free.find((one) => isClear(around(one, half, LINE_PX), things, names)) ?? free[0];
    if (!place) return false;
    taken.set(id, around(place, half, LINE_PX));
    written.set(id, { ...place, text });
    return true;
  };
  for (const label of labels) write(label, label.texts.at(-1) ?? '', true);
  for (const label of labels) {
    const at = written.get(label.id); // longer words only where the short ones stand, or beside what they name
    if (at) label.texts.slice(0, -1).some((text) => write({ ...label, at, others: [] }, text, false));
  }
  return written;
}

/** Where in a room its name lies over no thing, or over less, the middle and what is near to it first. */
export function freeIn(room: MapRoom, things: readonly MapThing[], scale: number): readonly Place[] {
  const middle = middleOf(room);
  const xs = room.corners.map(([x]) => x);
  const ys = room.corners.map(([, y]) => y);
  const between = (all: readonly number[], part: number) => Math.min(...all) + (Math.max(...all) - Math.min(...all)) * part;
  const far = (place: Place) => Math.hypot(place.x - middle.x, place.y - middle.y);
  const places = PARTS.flatMap((right) => PARTS.map((up) => ({ x: between(xs, right), y: between(ys, up) })));
  const near = [middle, ...places.sort((a, b) => far(a) - far(b))];
  const free = (half: Place) => ({ x, y }: Place) =>
    !things.some((one) => Math.abs(one.x - x) < one.width / 2 + half.x && Math.abs(one.y - y) < one.height / 2 + half.y);
  const whole = { x: (room.name.length * ROOM_LETTER_PX) / 2 / scale, y: LINE_PX / 2 / scale };
  return [...near.filter(free(whole)), ...near.filter(free(ROOM_FOR_NAME_M))];
}

/** The name of a robot, below or above it, or beside it where another robot's name stands. */
export function robotLabel(name: string, title: string, { x, y }: Place, radius: number): Label {
  const [beside, line] = [radius + (name.length * ROBOT_LETTER_PX) / 2, radius + LINE_PX / 2 + 2];
  const others = [{ x, y: y - line }, { x: x - beside, y }, { x: x + beside, y }];
  return { id: `robot ${name}`, texts: title ? [title, name] : [name], at: { x, y: y + line }, others, letterPx: ROBOT_LETTER_PX };
}

/** The name of a room. */
export function roomLabel(room: MapRoom, things: readonly MapThing[], view: Viewport, size: Size): Label {
  const [at, ...others] = [...freeIn(room, things, view.scale), middleOf(room)].map((place) => toScreen(view, size, place));
  return { id: `room ${room.name}`, texts: [room.name], at: at ?? { x: 0, y: 0 }, others, letterPx: ROOM_LETTER_PX, within: boxOf(room.corners, view, size) };
}

/** The name of a part of the map for which a rule holds. */
export function zoneLabel(zone: Rule, things: readonly MapThing[], view: Viewport, size: Size): Label {
  const corners = outline(cornersOf(zone)).map(([x, y]): [number, number] => [x, y]);
  return { ...roomLabel({ name: zone.name ?? '', corners }, things, view, size), id: `zone ${zone.id}`, letterPx: LETTER_PX };
}
