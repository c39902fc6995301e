import { useTranslation } from 'react-i18next';

import type { Line } from '@/live/lines';
import { useLive, useWorld } from '@/live/store';
import type { PlanView } from '@/live/types';
import { Empty } from '@/ui/panel';

import { PlanControls } from './plan-controls';
import css from './plan-panel.module.css';
import { ENDED } from './use-saving';

interface Props {
  plan: PlanView;
  lines: readonly Line[];
  current: number;
  onEdit: (() => void) | null;
}

/** How the plan fares, and what one can do about it. */
export function PlanBar({ plan, lines, current, onEdit }: Props) {
  const { t } = useTranslation('plan');
  // Held by nobody, it goes on only with an answer.
  const isWaiting = plan.state === 'running' && lines[current]?.step.state === 'waiting';
  return (
    <div className={css.bar} data-state={isWaiting ? 'held' : plan.state}>
      <p className={css.state}>
        {isWaiting ? t('step.waiting') : t(`state.${plan.state}`)}
        {current >= 0 && lines.length > 1 && t('stateStep', { number: current + 1, all: lines.length })}
      </p>
      <HeldBy by={plan.held_by} />
      <Away robot={plan.robot} />
      <PlanControls plan={plan} onEdit={onEdit} />
    </div>
  );
}

/** Why what is shown may not be how it is. */
function Away({ robot }: { robot: string }) {
  const { t } = useTranslation('plan');
  const here = useWorld((world) => world.robots[robot]?.connection === 'here');
  const lost = useLive((live) => live.connection === 'lost');
  if (here && !lost) return null;
  return <p className={css.away}>{lost ? t('old') : t('away', { robot })}</p>;
}

/** Who told it to stand still. */
function HeldBy({ by }: { by: PlanView['held_by'] }) {
  const { t } = useTranslation('plan');
  return by?.name ? <p>{t('heldBy', { who: by.name })}</p> : null;
}

/** That there is nothing to do, or where it is being changed nothing to change any more. */
export function Over({ plan, isEdited, waiting }: { plan: PlanView; isEdited: boolean; waiting: number }) {
  const { t } = useTranslation('plan');
  if (isEdited) {
    return (
      ENDED.includes(plan.state) && (
        <p role="status" className={css.over}>
          {t('conflictOver')}
        </p>
      )
    );
  }
  if (plan.steps.length > 0 || waiting > 0) return null;
  return (
    <Empty title={t('empty', { robot: plan.robot })}>
      <p>{t('emptyHelp')}</p>
    </Empty>
  );
}
