import { useTranslation } from 'react-i18next';

import { commandPlan, type PlanCommand } from '@/live/api';
import { isEarlier, linesOf, OVER } from '@/live/lines';
import type { PlanView, StepView } from '@/live/types';
import { useOpenQuestions } from '@/state/asked';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { quoted, sentence } from '@/ui/words';

import css from './plan-panel.module.css';
import { usePutBack } from './use-saving';

/** States in which there is nothing to control. */
const RESTING: readonly PlanView['state'][] = ['idle', 'awaiting_approval', 'ended'];

interface Props {
  plan: PlanView;
  /** Given if steps can be changed now. */
  onEdit: (() => void) | null;
}

/** Pause, continue, skip, cancel, change; each keeps its place, and what is lost by one of them can be put back. */
export function PlanControls({ plan, onEdit }: Props) {
  const { t } = useTranslation('plan');
  const offer = usePutBack(plan);
  const asks = useOpenQuestions().has(plan.robot);
  const order = (command: PlanCommand, step = '') => attempt(() => commandPlan(plan.robot, command, step));
  if (plan.kind !== 'plan' || RESTING.includes(plan.state)) return null;
  const standing = plan.state === 'paused' || plan.state === 'held';
  const left = linesOf(plan.steps).filter((line) => !isEarlier(line));
  const drop = async (sent: Promise<boolean>, gone: readonly StepView[], said: string, back?: string) => {
    if ((await sent) && gone.length > 0) offer(gone, said, back);
  };
  const skip = () => {
    const line = left[0];
    const gone = line ? [...line.finding, line.step] : [];
    const meant = gone.find((step) => !OVER.has(step.state) || step.state === 'failed');
    void drop(order('skip', meant?.planned), gone, t('skippedStep', { step: quoted(sentence(line?.step.label ?? '')) }));
  };
  const clear = () => {
    const gone = left.flatMap((line) => [...line.finding, line.step]);
    // What is put back begins at once, also where it stood still before: then it is not just undone.
    void drop(order('clear'), gone, t('cleared', { count: left.length }), standing ? t('beginAgain') : undefined);
  };
  return (
    <div className={css.controls} data-once>
      {standing ? (
        // While it asks something the answer is what comes first, and not going on.
        <Button needs="resume" tone={asks ? 'plain' : 'main'} icon="play" onPress={() => void order('resume')}>
          {t('resume')}
        </Button>
      ) : (
        <Button icon="pause" onPress={() => void order('pause')}>
          {t('pause')}
        </Button>
      )}
      <Button needs="edit" icon="skip" onPress={skip}>
        {t('skip')}
      </Button>
      <Button needs="edit" icon="edit" isDisabled={!onEdit} onPress={() => onEdit?.()}>
        {t('change')}
      </Button>
      <Button needs="clear" icon="trash" onPress={clear}>
        {t('clear')}
      </Button>
    </div>
  );
}
