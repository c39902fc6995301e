/** Steps that were taken out, put where they stood. Plain functions. */
import { linesOf, OVER } from '@/live/lines';
import type { StepView } from '@/live/types';

import { pendingSteps } from './editing';

interface PutBack {
  /** All that is to be done, in order. */
  steps: readonly StepView[];
  /** Those of the plan that are done anew: what was taken out, and what was begun in its place. */
  undoes: readonly string[];
}

/**
 * The plan as it was: what was taken out, then what was begun instead, from its beginning, then the rest. Only what is done
 * is not done again; who has left the place meanwhile where something is to be done goes there again.
 */
export function putBack(gone: readonly StepView[], before: readonly StepView[], now: readonly StepView[]): PutBack {
  const place = before.findLastIndex((one) => gone.some((out) => key(out) === key(one)));
  const behind = new Set(before.slice(place + 1).map(key));
  const instead = linesOf(now)
    .map((line) => [...line.finding, line.step])
    .filter((line) => line.some(({ state }) => state !== 'queued') && line.some((one) => behind.has(key(one)) && !OVER.has(one.state)))
    .flat();
  const rest = pendingSteps(now).filter((one) => !instead.some((other) => key(other) === key(one)));
  const next = rest.findIndex((one) => behind.has(key(one)));
  const at = instead.length > 0 ? 0 : next < 0 ? rest.length : next;
  const wayEnds = now.findLast((one) => one.risk === 'moves' && one.state !== 'queued');
  const here = wayEnds && !instead.some((one) => key(one) === key(wayEnds)) && wayEnds.state !== 'skipped' ? wayEnds : undefined;
  return {
    steps: withWays([...rest.slice(0, at), ...gone, ...instead, ...rest.slice(at)], before, here),
    undoes: [...gone, ...instead].flatMap(({ planned }) => planned || []),
  };
}

const key = (step: StepView) => step.planned || step.id;

/** What is done at the end of a way is done there, also where another way came between. */
function withWays(steps: readonly StepView[], before: readonly StepView[], start: StepView | undefined): readonly StepView[] {
  let here = start && key(start);
  return steps.flatMap((step) => {
    if (step.risk === 'moves') here = key(step);
    const way = step.risk === 'moves' || step.only_finds ? [] : wayTo(step, before);
    const end = way.at(-1);
    if (!end || key(end) === here) return [step];
    here = key(end);
    return [...way, step];
  });
}

/** The last steps before one that took the robot to where it is done. */
function wayTo(step: StepView, before: readonly StepView[]): readonly StepView[] {
  const at = before.findIndex((one) => key(one) === key(step));
  const earlier = before.slice(0, Math.max(at, 0)).filter(({ state }) => state !== 'skipped' && state !== 'stopped');
  const end = earlier.findLastIndex((one) => one.risk === 'moves');
  if (end < 0) return [];
  const start = earlier.slice(0, end).findLastIndex((one) => !one.only_finds) + 1;
  return earlier.slice(start, end + 1);
}
