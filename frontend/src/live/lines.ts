/** The steps of a plan as people see them. Plain functions. */
import type { StepState, StepView } from './types';

/** One step, with the searches that are made only for its sake. */
export interface Line {
  step: StepView;
  finding: readonly StepView[];
}

/** States in which a search has nothing to say that the step it is made for does not say. */
const SILENT: ReadonlySet<StepState> = new Set(['queued', 'finished', 'skipped']);
/** States of a step that is over. */
export const OVER: ReadonlySet<StepState> = new Set(['finished', 'failed', 'stopped', 'skipped']);

/** Finding out where something is belongs to the step that goes there. */
export function linesOf(steps: readonly StepView[]): readonly Line[] {
  const lines: Line[] = [];
  let finding: StepView[] = [];
  steps.forEach((step, index) => {
    const next = steps[index + 1];
    if (step.only_finds && next && feeds(step, next)) finding.push(step);
    else {
      lines.push({ step: together(step, finding), finding });
      finding = [];
    }
  });
  return lines;
}

/** What is over without having failed; the rest is still to be done or to be settled. */
export const isEarlier = ({ step }: Line) => OVER.has(step.state) && step.state !== 'failed';

const feeds = (step: StepView, next: StepView) =>
  step.outputs.some((output) => next.inputs.some((input) => input.name === output.name));

function together(step: StepView, finding: readonly StepView[]): StepView {
  if (finding.length === 0) return step;
  // Until the search has found something, how it fares is how the whole fares.
  const searching = step.state === 'queued' ? finding.find((one) => !SILENT.has(one.state)) : undefined;
  return {
    ...step,
    state: searching?.state ?? step.state,
    message: searching?.message || step.message,
    started_unix_ms: finding.find((one) => one.started_unix_ms > 0)?.started_unix_ms ?? step.started_unix_ms,
    worked_ms: finding.reduce((sum, one) => sum + one.worked_ms, step.worked_ms),
    working_since_unix_ms: Math.max(step.working_since_unix_ms, ...finding.map((one) => one.working_since_unix_ms)),
  };
}
