import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { commandPlan, type PlanCommand } from '@/live/api';
import type { PlanView } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Dialog, DialogButtons } from '@/ui/dialog';

import css from './plan-panel.module.css';

/** States in which there is nothing to control. */
const RESTING: readonly PlanView['state'][] = ['idle', 'awaiting_approval', 'ended'];

interface Props {
  plan: PlanView;
  /** Given if steps can be changed now. */
  onEdit: (() => void) | null;
}

/** Pause, continue, skip, cancel, change. */
export function PlanControls({ plan, onEdit }: Props) {
  const { t } = useTranslation('plan');
  const [clearing, setClearing] = useState(false);
  const order = (command: PlanCommand) => void attempt(() => commandPlan(plan.robot, command));
  if (plan.kind !== 'plan' || RESTING.includes(plan.state)) return null;
  const standing = plan.state === 'paused' || plan.state === 'held';
  return (
    <div className={css.controls}>
      {standing ? (
        <Button needs="resume" tone="main" icon="play" onPress={() => order('resume')}>
          {t('resume')}
        </Button>
      ) : (
        <Button icon="pause" onPress={() => order('pause')}>
          {t('pause')}
        </Button>
      )}
      <Button needs="edit" icon="skip" onPress={() => order('skip')}>
        {t('skip')}
      </Button>
      {onEdit && (
        <Button needs="edit" icon="edit" onPress={onEdit}>
          {t('change')}
        </Button>
      )}
      <Button needs="clear" icon="trash" onPress={() => setClearing(true)}>
        {t('clear')}
      </Button>
      <Dialog
        role="alertdialog"
        title={t('clearTitle', { robot: plan.robot })}
        isOpen={clearing}
        onClose={() => setClearing(false)}
      >
        <p>{t('clearText', { robot: plan.robot })}</p>
        <DialogButtons>
          <Button onPress={() => setClearing(false)}>{t('clearNo')}</Button>
          <Button
            tone="danger"
            onPress={() => {
              setClearing(false);
              order('clear');
            }}
          >
            {t('clearYes')}
          </Button>
        </DialogButtons>
      </Dialog>
    </div>
  );
}
