/** A plan while it is being changed. Plain functions. */
import type { ActionCall, AbilityView, ParameterView, StepView } from '@/live/types';
import { inWords } from '@/ui/words';

import { linesOf } from '@/live/lines';
import { emptyTree, withInput } from './parameters';

export interface DraftStep {
  id: string;
  label: string;
  action: string;
  inputs: readonly ParameterView[];
  call: ActionCall;
  /** Of a new step: its label with `{parameter}` for values; `{place}` is what its search looks for. */
  template?: string;
  /** Searches that are made only for its sake, right before it. */
  finding: readonly DraftStep[];
}

/** Steps that may still be changed: those that have not begun. */
export const pendingSteps = (steps: readonly StepView[]) => steps.filter((step) => step.state === 'queued');

/** Of the steps of now what each was then. */
function paired(then: readonly StepView[], now: readonly StepView[]): ReadonlyMap<StepView, StepView> {
  const known = new Map<StepView, StepView>();
  const pair = (isSame: (one: StepView, other: StepView) => boolean) => {
    const left = new Set(then.filter((one) => ![...known.values()].includes(one)));
    for (const step of now.filter((one) => !known.has(one))) {
      const same = [...left].find((one) => isSame(one, step));
      if (same) known.set(step, same);
      if (same) left.delete(same);
    }
  };
  pair((one, other) => (one.planned || one.id) === (other.planned || other.id));
  pair((one, other) => one.action === other.action && one.label === other.label); // after a restart they have other ids
  return known;
}

/**
 * Which of the steps that could be changed have begun since, which of the others that had begun then wait again, as after a
 * restart, and whether nothing else is otherwise.
 */
export function sinceThen(then: readonly StepView[], now: readonly StepView[]) {
  const known = paired(then, now);
  const isBegun = (step: StepView) => now.some((one) => known.get(one) === step && one.state !== 'queued');
  const [begun, left] = [pendingSteps(then).filter(isBegun), pendingSteps(then).filter((step) => !isBegun(step))];
  const again = pendingSteps(now).filter((one) => (known.get(one)?.state ?? 'queued') !== 'queued');
  const still = pendingSteps(now).filter((one) => !again.includes(one));
  return {
    begun: begun.map((step) => step.id),
    again,
    isSame: left.length === still.length && still.every((step, at) => known.get(step) === left[at]),
  };
}

/**
 * What one has made of the steps of then, taken over into those of now: what others took out or began is out, what they added
 * stands behind what they put it behind, what they changed is so unless one has changed it oneself.
 */
export function rebased(then: readonly StepView[], mine: readonly DraftStep[], now: readonly StepView[]): readonly DraftStep[] {
  const known = new Map([...paired(then, now)].map(([is, was]) => [is.id, was.id]));
  const waited = new Map(toDrafts(pendingSteps(then)).map((step) => [step.id, step]));
  const waits = toDrafts(pendingSteps(now));
  const left = mine.flatMap((step) => {
    const was = waited.get(step.id);
    if (!was) return step; // a new one
    const is = waits.find(({ id }) => known.get(id) === step.id);
    if (!is) return [];
    return JSON.stringify(callsOf([was])) === JSON.stringify(callsOf([step])) ? is : { ...step, id: is.id };
  });
  return waits.reduce<readonly DraftStep[]>((all, step, at) => {
    if (waited.has(known.get(step.id) ?? '')) return all;
    const ahead = waits.slice(0, at).map(({ id }) => id);
    return all.toSpliced(all.findLastIndex(({ id }) => ahead.includes(id)) + 1, 0, step);
  }, left);
}

/** Without those that have begun; the others stay what they are. */
export const without = (steps: readonly DraftStep[], begun: readonly string[]): readonly DraftStep[] => {
  const stays = (step: DraftStep) => !begun.includes(step.id);
  return steps.filter(stays).map((step) => (step.finding.every(stays) ? step : { ...step, finding: step.finding.filter(stays) }));
};

export const toDrafts = (steps: readonly StepView[]): readonly DraftStep[] =>
  linesOf(steps).map(({ step, finding }) => ({ ...toDraft(step), finding: finding.map(toDraft) }));

function toDraft(step: StepView): DraftStep {
  return { id: step.id, label: step.label, action: step.action, inputs: step.inputs, call: step.call ?? {}, finding: [] };
}

/** The steps as they are sent. */
export const callsOf = (steps: readonly DraftStep[]): readonly ActionCall[] =>
  steps.flatMap((step) => [...step.finding.map((one) => one.call), step.call]);

/** Whether steps that are to be sent are those that wait in a plan already. */
export const asItIs = (now: readonly StepView[], calls: readonly ActionCall[]) =>
  JSON.stringify(calls) === JSON.stringify(callsOf(toDrafts(pendingSteps(now))));

/** What a person can change of a step, that of its searches first. */
export const inputsOf = (step: DraftStep) => [...step.finding.flatMap((one) => one.inputs), ...step.inputs].filter(editable);

/** What can be added: an action, with the search for its place if it takes one. */
export interface Addable {
  action: AbilityView;
  finder: AbilityView | null;
}

/** All that a robot can do as steps; a search that a drive brings along does not stand alone. */
export function addables(catalogue: readonly AbilityView[]): readonly Addable[] {
  const all = catalogue.map((action): Addable => ({ action, finder: catalogue.find((one) => finds(one, action)) ?? null }));
  return all.filter(({ action }) => !all.some(({ finder }) => finder === action));
}

/** Whether one action finds the place that the other needs. */
function finds(finder: AbilityView, action: AbilityView): boolean {
  const places = Object.keys(action.inputs ?? {}).filter((name) => PLACE.test(name));
  return places.length > 0 && finder.effects.includes('locates') && places.every((name) => name in (finder.outputs ?? {}));
}

/** What an action is called among people. */
export const nameOfAction = (action: AbilityView) => action.label.replaceAll(/\{\w+\}/g, '…') || inWords(action.name);

/** A new step, its inputs still empty. */
export function newStep({ action, finder }: Addable, id: string): DraftStep {
  const inputs = Object.entries(action.inputs ?? {}).map(([name, type]) => ({ name, type, value: null }));
  return {
    id,
    label: nameOfAction(action),
    template: action.label,
    action: action.name,
    inputs,
    call: {
      [action.name]: {
        input_parameters: emptyTree(action.inputs ?? {}),
        output_parameters: emptyTree(action.outputs ?? {}),
      },
    },
    finding: finder ? [newStep({ action: finder, finder: null }, `${id} finds`)] : [],
  };
}

type Value = string | number | boolean;

/** The step with another value, and a label that says so. */
export function setInput(step: DraftStep, name: string, value: Value): DraftStep {
  const before = inputsOf(step).find((input) => input.name === name)?.value;
  const next = withValue(step, name, value);
  return { ...next, label: step.template ? filled(next, step.template) : renamed(step.label, before, value) };
}

function withValue(step: DraftStep, name: string, value: Value): DraftStep {
  const searched = step.finding.find((one) => one.inputs.some((input) => input.name === name && editable(input)));
  if (searched) {
    return { ...step, finding: step.finding.map((one) => (one === searched ? withValue(one, name, value) : one)) };
  }
  const input = step.inputs.find((one) => one.name === name);
  if (!input) return step;
  return {
    ...step,
    inputs: step.inputs.map((one) => (one.name === name ? { ...one, value } : one)),
    call: withInput(step.call, name, input.type, value),
  };
}

const quoted = (value: unknown) => (typeof value === 'string' ? `“${value}”` : String(value));

const filled = (step: DraftStep, template: string) =>
  template.replaceAll(/\{(\w+)\}/g, (_, name: string) => {
    const inputs = inputsOf(step);
    const value = (inputs.find((input) => input.name === name) ?? (name === 'place' ? inputs[0] : undefined))?.value;
    return value === null || value === undefined || value === '' ? '…' : quoted(value);
  });

/** The server's label with a value changed in it; each language has quotation marks of its own. */
function renamed(label: string, before: unknown, value: Value): string {
  if (before === null || before === undefined) return label;
  const marks = ['“”', '„“', '„”', '«»', '»«', '””', '""'].find(([open, close]) => label.includes(`${open}${String(before)}${close}`));
  const [open = '', close = ''] = typeof before === 'string' ? (marks ?? '“”') : '';
  return label.replace(`${open}${String(before)}${close}`, () => `${open}${String(value)}${close}`);
}

/** Move the steps `ids` in front of or behind `target`. */
export function moved(
  steps: readonly DraftStep[],
  ids: ReadonlySet<string>,
  target: string,
  where: 'before' | 'after',
): readonly DraftStep[] {
  if (ids.has(target)) return steps;
  const rest = steps.filter((step) => !ids.has(step.id));
  const at = rest.findIndex((step) => step.id === target) + (where === 'after' ? 1 : 0);
  return [...rest.slice(0, at), ...steps.filter((step) => ids.has(step.id)), ...rest.slice(at)];
}

/** Move one step by one place. */
export function nudged(steps: readonly DraftStep[], id: string, by: -1 | 1): readonly DraftStep[] {
  const at = steps.findIndex((step) => step.id === id);
  const neighbour = steps[at + by];
  return neighbour ? moved(steps, new Set([id]), neighbour.id, by < 0 ? 'before' : 'after') : steps;
}

const PLACE = /(?:^|::)(?:position|orientation)::/;

/** Inputs a person can write down: words, numbers and yes or no; places come from other steps. */
export const editable = (input: ParameterView) => ['string', 'number', 'bool'].includes(input.type) && !PLACE.test(input.name);
