import { useTranslation } from 'react-i18next';

import { ApiError, putSteps } from '@/live/api';
import { useLive } from '@/live/store';
import type { ActionCall, PlanView, StepView } from '@/live/types';
import { explain } from '@/state/do';
import { useToasts } from '@/state/toasts';
import { sentence } from '@/ui/words';

import { pendingSteps, putBack } from './editing';
import type { Line } from '@/live/lines';

type Outcome = 'saved' | 'refused' | 'conflict';

/** Sends changed steps and says what came of it; `conflict`: the plan has moved on meanwhile. */
export function useSaving() {
  const { t } = useTranslation('plan');
  const show = useToasts((state) => state.show);
  return async (robot: string, calls: readonly ActionCall[], revision: number, said = t('saved')): Promise<Outcome> => {
    try {
      await putSteps(robot, calls, revision);
      if (said) show({ tone: 'info', message: said });
      return 'saved';
    } catch (error) {
      const conflict = error instanceof ApiError && error.status === 409;
      show({ tone: 'error', message: conflict ? t('conflict') : explain(error) });
      return conflict ? 'conflict' : 'refused';
    }
  };
}

/** Takes one step that has not begun out of a plan, with the search for its place; it can be put back for a while. */
export function useRemoving(plan: PlanView) {
  const { t } = useTranslation(['plan', 'common']);
  const show = useToasts((state) => state.show);
  const save = useSaving();
  return async ({ step, finding }: Line) => {
    const before = pendingSteps(plan.steps);
    const out = [...finding, step].map((one) => one.id);
    const gone = before.filter((one) => out.includes(one.id));
    const rest = before.filter((one) => !out.includes(one.id));
    const outcome = await save(plan.robot, rest.map(callOf), plan.revision, '');
    if (outcome !== 'saved') return;
    const undo = () => {
      const now = Object.values(useLive.getState().world.plans).find(
        (one) => one.robot === plan.robot && one.kind === 'plan',
      );
      const still = now ? pendingSteps(now.steps) : [];
      const steps = gone.toReversed().reduce<readonly StepView[]>((known, one) => putBack(one, before, known), still);
      void save(plan.robot, steps.map(callOf), now?.revision ?? plan.revision);
    };
    show({
      tone: 'info',
      message: t('removed', { step: sentence(step.label) }),
      action: { label: t('common:undo'), run: undo },
    });
  };
}

const callOf = (step: StepView): ActionCall => step.call ?? {};
