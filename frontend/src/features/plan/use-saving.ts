import { useTranslation } from 'react-i18next';

import { ApiError, putSteps } from '@/live/api';
import { useLive } from '@/live/store';
import type { ActionCall, PlanView, StepView } from '@/live/types';
import { explain } from '@/state/do';
import { useToasts } from '@/state/toasts';
import { quoted, sentence } from '@/ui/words';

import { pendingSteps, putBack } from './editing';
import type { Line } from '@/live/lines';

type Outcome = 'saved' | 'refused' | 'conflict';

const ownPlan = (robot: string) =>
  Object.values(useLive.getState().world.plans).find((one) => one.robot === robot && one.kind === 'plan');

/** Sends changed steps and says what came of it; `conflict`: the plan has moved on meanwhile. */
export function useSaving() {
  const { t } = useTranslation('plan');
  const show = useToasts((state) => state.show);
  return async (robot: string, calls: readonly ActionCall[], revision: number, said = t('saved')): Promise<Outcome> => {
    useToasts.getState().anew();
    try {
      await putSteps(robot, calls, revision);
      if (said) show({ tone: 'info', message: said });
      return 'saved';
    } catch (error) {
      const conflict = error instanceof ApiError && error.status === 409;
      const name = ownPlan(robot)?.graph_name;
      const stands = () => ownPlan(robot)?.graph_name === name && ownPlan(robot)?.state !== 'ended';
      show({ tone: 'error', message: conflict ? t('conflict') : explain(error), stands: conflict ? stands : 'deed' });
      return conflict ? 'conflict' : 'refused';
    }
  };
}

/** Says that steps are out of a plan, and puts them back where they stood if a person wants that. */
export function usePutBack(plan: PlanView) {
  const { t } = useTranslation(['plan', 'common']);
  const show = useToasts((state) => state.show);
  const save = useSaving();
  return (gone: readonly StepView[], message: string, label = t('common:undo')) => {
    const undo = () => {
      const now = ownPlan(plan.robot);
      const still = now ? pendingSteps(now.steps) : [];
      void save(plan.robot, putBack(gone, plan.steps, still).map(callOf), now?.revision ?? plan.revision, '');
    };
    show({ tone: 'info', message, action: { label, run: undo } });
  };
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
    const outcome = await save(plan.robot, rest.map(callOf), plan.revision, '');
    if (outcome === 'saved') offer(gone, t('removed', { step: quoted(sentence(step.label)) }));
  };
}

const callOf = (step: StepView): ActionCall => step.call ?? {};
