/** What can be picked out on the map, and what it is called. Plain functions. */
import type { ChatEntry, MapInfo, MapRoom, MapThing } from '@/live/types';

import { roomAt, thingAt, type Place } from './viewport';

export type Mark = ({ kind: 'place' } | { kind: 'thing'; thing: MapThing } | { kind: 'room'; room: MapRoom }) & { at: Place };

/** What is picked out by pointing at a place: a thing there, else the room, unless the room is picked out already. */
export function markAt(map: MapInfo, at: Place, reachM: number, before: Mark | null): Mark {
  const thing = thingAt(map.objects, at, reachM);
  if (thing) return { kind: 'thing', thing, at: { x: thing.x, y: thing.y } };
  const room = roomAt(map.rooms, at);
  const again = before !== null && before.kind !== 'thing' && roomAt(map.rooms, before.at) === room;
  return room && !again ? { kind: 'room', room, at } : { kind: 'place', at };
}

/** What a thing is called among people. */
export const nameOf = (thing: MapThing) => thing.description || thing.kind;

/** What a robot asked about that is on the map: thing's id -> number of the answer, from 1, and its words. */
export type Candidates = ReadonlyMap<string, { number: number; choice: string }>;

export function candidatesOf(map: MapInfo, question: ChatEntry | undefined): Candidates {
  const found = (question?.choices ?? []).flatMap((choice, index) => {
    const fitting = map.objects.filter((thing) => nameOf(thing).toLowerCase() === choice.toLowerCase());
    const thing = fitting[0];
    return thing && fitting.length === 1 ? [[thing.id, { number: index + 1, choice }] as const] : [];
  });
  return new Map(found);
}
