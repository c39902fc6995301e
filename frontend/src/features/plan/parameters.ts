/** Values of steps as people read them. Plain functions. */
import type { ActionCall, ParameterInfo, ParameterView, StepView } from '@/live/types';
import { inWords, sentence } from '@/ui/words';

export type Row =
  | { kind: 'value'; name: string; label: string; value: string | null }
  | { kind: 'place'; name: string; label: string; x: number; y: number; degrees: number | null };

const AXIS = /^(?:(.+)::)?position::([xyz])$/;
const TURN = /^(?:(.+)::)?orientation::([rpy])$/;

/** What people call an input: what the action says that it means, up to the first pause in it, or else its name. */
export function labelOf(name: string, about: ParameterInfo | undefined): string {
  const meaning = about?.help.split(/[,;.:(]/)[0]?.trim() ?? '';
  return meaning ? sentence(meaning) : inWords(name);
}

/** Parameters as rows: coordinates of one place are drawn together. `about` is what is known of some of them; ids are for programs. */
export function rowsOf(all: readonly ParameterView[], about: Readonly<Record<string, ParameterInfo>> = {}): readonly Row[] {
  const rows: Row[] = [];
  const places = new Map<string, Map<string, unknown>>();
  const parameters = all.filter(({ name }) => about[name]?.kind !== 'id');
  for (const parameter of parameters) {
    const axis = AXIS.exec(parameter.name);
    const turn = axis ? null : TURN.exec(parameter.name);
    const match = axis ?? turn;
    if (!match) {
      rows.push({ kind: 'value', name: parameter.name, label: labelOf(parameter.name, about[parameter.name]), value: shown(parameter.value) });
      continue;
    }
    const name = match[1] ?? '';
    const parts = places.get(name) ?? new Map<string, unknown>();
    parts.set(axis ? (match[2] ?? '') : `turn_${match[2] ?? ''}`, parameter.value);
    places.set(name, parts);
  }
  return [...rows, ...[...places].map(([name, parts]) => placeRow(name, parts))];
}

/** Steps that have begun, with what they got from steps before them. */
export function withReceived(steps: readonly StepView[]): readonly StepView[] {
  const found = new Map<string, ParameterView>();
  return steps.map((step) => {
    const inputs = step.state === 'queued' ? step.inputs : step.inputs.map((input) => known(input) ?? found.get(keyOf(input)) ?? input);
    for (const output of step.outputs) if (known(output)) found.set(keyOf(output), output);
    return { ...step, inputs };
  });
}

const known = (one: ParameterView) => (one.value === null || one.value === undefined ? null : one);
const keyOf = (one: ParameterView) => `${one.name} ${one.type}`;

function placeRow(name: string, parts: ReadonlyMap<string, unknown>): Row {
  const [x, y, yaw] = [parts.get('x'), parts.get('y'), parts.get('turn_y')];
  if (typeof x !== 'number' || typeof y !== 'number') return { kind: 'value', name, label: '', value: null };
  const degrees = typeof yaw === 'number' ? Math.round((yaw * 180) / Math.PI) : null;
  return { kind: 'place', name, label: '', x, y, degrees };
}

function shown(value: unknown): string | null {
  if (value === null || value === undefined) return null;
  if (typeof value === 'number') return String(Math.round(value * 100) / 100);
  return typeof value === 'string' ? value : JSON.stringify(value);
}

interface CallBody {
  input_parameters?: Record<string, unknown>;
  [key: string]: unknown;
}

/** The name and body of a step in the form in which it is sent. */
function opened(call: ActionCall): [string, CallBody] {
  const [name = '', body = {}] = Object.entries(call)[0] ?? [];
  return [name, body as CallBody];
}

/** The same step with another value for one input. `name` is flat: `a::b`. */
export function withInput(call: ActionCall, name: string, type: string, value: string | number | boolean): ActionCall {
  const [action, body] = opened(call);
  return { [action]: { ...body, input_parameters: put(body.input_parameters ?? {}, name.split('::'), type, value) } };
}

function put(tree: Record<string, unknown>, path: readonly string[], type: string, value: unknown): Record<string, unknown> {
  const [head = '', ...rest] = path;
  const below = (tree[head] ?? {}) as Record<string, unknown>;
  const leaf = { ...below, pvf_type: type, pvf_value: value };
  return { ...tree, [head]: rest.length === 0 ? leaf : put(below, rest, type, value) };
}

/** Inputs and outputs without values, as a tree of the form in which they are sent. */
export function emptyTree(types: Readonly<Record<string, string>>): Record<string, unknown> {
  return Object.entries(types).reduce<Record<string, unknown>>((tree, [name, type]) => grow(tree, name.split('::'), type), {});
}

function grow(tree: Record<string, unknown>, path: readonly string[], type: string): Record<string, unknown> {
  const [head = '', ...rest] = path;
  const below = (tree[head] ?? {}) as Record<string, unknown>;
  return { ...tree, [head]: rest.length === 0 ? { pvf_type: type } : grow(below, rest, type) };
}
