/** Zones: their corners as written text, as drawn, as the server takes them, in metres of the map; and ids of rules. */
import type { MapThing, Rule } from '@/live/types';

export type Corner = readonly [number, number];

export const cornerAt = ({ x, y }: { x: number; y: number }): Corner => [round(x), round(y)];

const round = (value: number) => Math.round(value * 100) / 100;

/** `1,2 4,2 4,5` as corners; null while a corner is not written out. */
export function readCorners(text: string): Corner[] | null {
  const parts = text.trim().split(/[\s;]+/).filter(Boolean);
  const corners = parts.map((part) => part.split(',').map(Number));
  const whole = corners.every((corner) => corner.length === 2 && corner.every(Number.isFinite));
  return whole ? corners.map(([x = 0, y = 0]) => [x, y] as const) : null;
}

export const writeCorners = (corners: readonly Corner[]): string => corners.map(([x, y]) => `${round(x)},${round(y)}`).join(' ');

/** The fields of a rule; two corners are a rectangle. */
export function areaOf(corners: readonly Corner[]): Pick<Rule, 'rectangle' | 'polygon'> {
  const [first, second] = corners;
  if (corners.length === 2 && first && second) return { rectangle: [...first, ...second], polygon: null };
  return { rectangle: null, polygon: corners.map(([x, y]) => [x, y]) };
}

/** What was written of a rule's area. */
export function cornersOf(rule: Rule): Corner[] {
  if (rule.rectangle) {
    const [x1, y1, x2, y2] = rule.rectangle;
    return [
      [x1, y1],
      [x2, y2],
    ];
  }
  return (rule.polygon ?? []).map(([x, y]) => [x, y] as const);
}

/** All corners around an area, in order. */
export function outline(corners: readonly Corner[]): readonly Corner[] {
  const [first, second] = corners;
  if (corners.length !== 2 || !first || !second) return corners;
  return [first, [second[0], first[1]], second, [first[0], second[1]]];
}

const MARGIN_M = 0.3;

/** Around a thing, with a little room. */
export function around(thing: MapThing): Corner[] {
  const wide = (thing.width ?? 0) / 2 + MARGIN_M;
  const high = (thing.height ?? 0) / 2 + MARGIN_M;
  return [
    [round(thing.x - wide), round(thing.y - high)],
    [round(thing.x + wide), round(thing.y + high)],
  ];
}

/** An id that no other rule has, from words about it. */
export function idFor(words: string, rules: readonly Rule[]): string {
  const base = (words.toLowerCase().match(/[a-z0-9]+/g) ?? ['rule']).join('-').slice(0, 50);
  const taken = new Set(rules.map((rule) => rule.id));
  let id = base;
  for (let count = 2; taken.has(id); count += 1) id = `${base}-${count}`;
  return id;
}
