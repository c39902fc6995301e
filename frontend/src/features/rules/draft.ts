/** A rule as it is written in the form: everything is text until it is sent. */
import type { Rule } from '@/live/types';

import { areaOf, cornersOf, readCorners, writeCorners } from '@/ui/corners';

export type Kind = Rule['kind'];
export type Day = NonNullable<NonNullable<Rule['when']>['days']>[number];

export const kinds: readonly Kind[] = ['keep_out', 'slow', 'ask_zone', 'speed', 'action', 'plan'];
export const days: readonly Day[] = ['mon', 'tue', 'wed', 'thu', 'fri', 'sat', 'sun'];
export const isZone = (kind: Kind) => kind === 'keep_out' || kind === 'slow' || kind === 'ask_zone';
export const isLimited = (kind: Kind) => kind === 'slow' || kind === 'speed';

/** `what` is the name of an action, a class of them after a colon, or empty for all. */
export interface Draft {
  id: string;
  kind: Kind;
  name: string;
  corners: string;
  speed: string;
  verdict: 'forbid' | 'ask';
  what: string;
  distance: string;
  steps: string;
  seconds: string;
  robot: string;
  from: string;
  to: string;
  days: readonly Day[];
  exempt: boolean;
}

const EMPTY: Draft = {
  id: '', kind: 'keep_out', name: '', corners: '', speed: '', verdict: 'forbid', what: '', distance: '', steps: '',
  seconds: '', robot: '', from: '', to: '', days: [], exempt: false,
};

const text = (value: number | null | undefined) => (typeof value === 'number' ? String(value) : '');

function whatOf({ actions = [], classes = [] }: Rule): string {
  return actions[0] ?? (classes[0] ? `:${classes[0]}` : '');
}

/** What a rule looks like in the form; without one a new rule. */
export function draftOf(rule: Rule | null): Draft {
  if (!rule) return EMPTY;
  const { id, kind, name = '', verdict = 'forbid', robots = [], exempt = [] } = rule;
  const limits = { speed: text(rule.max_speed_mps), distance: text(rule.max_distance_m), steps: text(rule.max_steps), seconds: text(rule.max_expected_s) };
  const about = { id, kind, name, verdict, robot: robots[0] ?? '', exempt: exempt.includes('supervisor') };
  return { ...about, ...limits, ...hoursOf(rule), corners: writeCorners(cornersOf(rule)), what: whatOf(rule) };
}

function hoursOf({ when }: Rule): Pick<Draft, 'from' | 'to' | 'days'> {
  return { from: when?.from ?? '', to: when?.to ?? '', days: when?.days ?? [] };
}

const number = (value: string) => (value.trim() === '' ? null : Number(value.replace(',', '.')));

/** What only rules of this kind say. */
function fieldsOf(draft: Draft, before: Rule | null): Partial<Rule> {
  const speed = { max_speed_mps: number(draft.speed) };
  const area = { name: draft.name, map: before?.map ?? '', ...areaOf(readCorners(draft.corners) ?? []) };
  switch (draft.kind) {
    case 'keep_out':
    case 'ask_zone':
      return area;
    case 'slow':
      return { ...area, ...speed };
    case 'speed':
      return speed;
    case 'action':
      return { verdict: draft.verdict, ...actionsOf(draft, before) };
    case 'plan':
      return {
        verdict: draft.verdict,
        max_distance_m: number(draft.distance),
        max_steps: number(draft.steps),
        max_expected_s: number(draft.seconds),
      };
  }
}

function actionsOf({ what }: Draft, before: Rule | null): Partial<Rule> {
  if (before?.kind === 'action' && whatOf(before) === what) return { actions: before.actions ?? [], classes: before.classes ?? [] };
  if (what.startsWith(':')) return { classes: [what.slice(1) as NonNullable<Rule['classes']>[number]] };
  return { actions: what ? [what] : [] };
}

function robotsOf({ robot }: Draft, before: Rule | null): string[] {
  const known = before?.robots ?? [];
  if (known[0] === robot) return [...known];
  return robot ? [robot] : [];
}

function whenOf({ from, to, days: chosen }: Draft): Rule['when'] {
  if (!from && !to && chosen.length === 0) return null;
  return { days: [...chosen], from: from || null, to: to || null };
}

/** The rule to send. @param before What is changed: what the form does not show stays. */
export function ruleOf(draft: Draft, before: Rule | null, id: string): Rule {
  return {
    id,
    kind: draft.kind,
    ...fieldsOf(draft, before),
    robots: robotsOf(draft, before),
    exempt: draft.exempt ? ['supervisor'] : [],
    when: whenOf(draft),
    words: before?.words ?? '',
    by: before?.by ?? '',
  } as Rule;
}
