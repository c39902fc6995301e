import { useEffect } from 'react';
import { useTranslation } from 'react-i18next';

import { ApiError, putSteps } from '@/live/api';
import { useLive } from '@/live/store';
import type { ActionCall, PlanView, StepView } from '@/live/types';
import { explain } from '@/state/do';
import { untilReached, useToasts } from '@/state/toasts';
import { quoted, sentence } from '@/ui/words';

import { pendingSteps } from './editing';
import { carryOver } from './lasting';
import { putBack } from './putting-back';
import { OVER, type Line } from '@/live/lines';

type Outcome = 'saved' | 'refused' | 'conflict';

/** How often steps are put back into a plan that moves on just then, and how long it may take to hear that it did. */
const TRIES = 3;
const MOVED_ON_MS = 2000;

export const ownPlan = (robot: string) =>
  Object.values(useLive.getState().world.plans).find((one) => one.robot === robot && one.kind === 'plan');

const keyOf = (step: StepView) => step.planned || step.id;

/** Whether one more is to be done that is just so, than there was without it. */
function isBack(step: StepView | undefined, left: readonly StepView[], now: readonly StepView[]): boolean {
  const alike = (steps: readonly StepView[]) =>
    steps.filter((one) => one.action === step?.action && one.label === step.label && !OVER.has(one.state)).length;
  return alike(now) > alike(left);
}

const isDone = (robot: string, meant: StepView | undefined) =>
  Boolean(meant?.planned) && ownPlan(robot)?.steps.some((step) => step.planned === meant?.planned && step.state === 'finished');

/** As long as there is something to change. */
function whileItGoesOn(robot: string): () => boolean {
  const name = ownPlan(robot)?.graph_name;
  return () => ownPlan(robot)?.graph_name === name && ownPlan(robot)?.state !== 'ended';
}

const isUnreached = (error: unknown) => error instanceof ApiError && error.status === 0;
const isConflict = (error: unknown) => error instanceof ApiError && error.status === 409;

/** Sends changed steps and says what came of it; `conflict`: the plan has moved on meanwhile. */
export function useSaving() {
  const { t } = useTranslation('plan');
  const show = useToasts((state) => state.show);
  return async (robot: string, save: () => Promise<unknown>, said = t('saved'), passed: string | null = t('conflict')): Promise<Outcome> => {
    useToasts.getState().anew();
    try {
      await save();
      if (said) show({ tone: 'info', message: said });
      return 'saved';
    } catch (error) {
      const conflict = isConflict(error);
      const stands = whileItGoesOn(robot);
      const otherwise = isUnreached(error) ? untilReached() : 'deed';
      const message = conflict ? passed : explain(error);
      if (message) show({ tone: 'error', message, stands: conflict ? stands : otherwise });
      return conflict ? 'conflict' : 'refused';
    }
  };
}

/** What a plan is that goes on no more. */
export const ENDED: readonly PlanView['state'][] = ['ended', 'idle'];

/**
 * What somebody is changing stands in what others make of the plan meanwhile, as soon as that is heard.
 * @param then The plan that it is kept under a name for.
 */
export function useKeptInPlan(id: string, then: PlanView | null, plan: PlanView, isSame: boolean): void {
  const { t } = useTranslation('plan');
  const show = useToasts((state) => state.show);
  useEffect(() => {
    if (!then || isSame || ENDED.includes(plan.state)) return;
    const isLeft = carryOver(id, then.steps, plan, true);
    show({ tone: 'error', message: t(isLeft ? 'conflictKept' : 'conflictPast'), stands: whileItGoesOn(plan.robot) });
  }, [id, then, plan, isSame, show, t]);
}

/** The plan moved on before a change of it arrived: true if it is over, and there is nothing to change any more. */
export function usePassed() {
  const { t } = useTranslation('plan');
  const show = useToasts((state) => state.show);
  return async (robot: string, revision: number) => {
    await movedOn(robot, revision);
    const isOver = ENDED.includes(ownPlan(robot)?.state ?? 'idle');
    show({ tone: 'error', message: t(isOver ? 'conflictOver' : 'conflictKept'), stands: isOver ? 'deed' : whileItGoesOn(robot) });
    return isOver;
  };
}

/** Says that steps are out of a plan, and puts them back where they stood if a person wants that. */
export function usePutBack(plan: PlanView) {
  const { t } = useTranslation(['plan', 'common']);
  const show = useToasts((state) => state.show);
  const save = useSaving();
  return (gone: readonly StepView[], message: string, label = t('common:undo')) => {
    // What was done before it was heard is not out, and is not to be done once more, nor is what somebody else has put back; a
    // search goes with what it is made for.
    const rest = (steps: readonly StepView[]) => steps.filter((step) => !gone.some((one) => keyOf(one) === keyOf(step)));
    const left = rest(plan.steps);
    let isOut = false; // until it is heard that it is
    const out = () => {
      const now = ownPlan(plan.robot)?.steps ?? [];
      const isOpen = (step: StepView) => now.some((one) => keyOf(one) === keyOf(step) && !OVER.has(one.state));
      isOut ||= !gone.some(isOpen);
      const isIn = (step?: StepView) => isDone(plan.robot, step) || isBack(step, left, rest(now)) || (isOut && step !== undefined && isOpen(step));
      return gone.filter((_, at) => !isIn(gone.slice(at).find((step) => !step.only_finds)));
    };
    const stands = () => out().length > 0;
    const undo = async (tries = TRIES): Promise<void> => {
      const now = ownPlan(plan.robot);
      const revision = (now ?? plan).revision;
      const { steps, undoes } = putBack(out(), plan.steps, now?.steps ?? []);
      try {
        await putSteps(plan.robot, steps.map(callOf), revision, undoes);
      } catch (error) {
        if (tries <= 1 || !isConflict(error)) throw error;
        await movedOn(plan.robot, revision);
        await undo(tries - 1);
      }
    };
    if (stands()) show({ tone: 'info', message, action: { label, run: () => void save(plan.robot, undo, '') }, stands });
  };
}

/** Heard, or not in time, that a plan is another by now. */
const movedOn = (robot: string, revision: number) => heard(() => ownPlan(robot)?.revision !== revision);

/** Something is so, or did not become so in time. */
export async function heard(isPast: () => boolean): Promise<void> {
  if (isPast()) return;
  await new Promise<void>((settle) => {
    const timer = setTimeout(settle, MOVED_ON_MS);
    const leave = useLive.subscribe(() => {
      if (!isPast()) return;
      clearTimeout(timer);
      leave();
      settle();
    });
  });
}

/** Takes one step that has not begun out of a plan, with the search for its place; it can be put back for a while. */
export function useRemoving(plan: PlanView) {
  const { t } = useTranslation('plan');
  const save = useSaving();
  const offer = usePutBack(plan);
  return async ({ step, finding }: Line) => {
    const gone = [...finding, step];
    const out = gone.map((one) => one.id);
    const rest = pendingSteps(plan.steps).filter((one) => !out.includes(one.id));
    const outcome = await save(plan.robot, () => putSteps(plan.robot, rest.map(callOf), plan.revision), '');
    if (outcome === 'saved') offer(gone, t('removed', { step: quoted(sentence(step.label)) }));
  };
}

const callOf = (step: StepView): ActionCall => step.call ?? {};
