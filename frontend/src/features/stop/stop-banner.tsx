import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { RobotView } from '@/live/types';
import { attempt } from '@/state/do';
import { stoppedRobots, useStopping } from '@/state/stopping';
import { Button } from '@/ui/button';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { Icon } from '@/ui/icon';
import { clockTime } from '@/ui/words';

import css from './stop.module.css';

/** What became of a stop, robot by robot, and the way out of it. */
export function StopBanner() {
  const { t } = useTranslation(['stop', 'common']);
  const robots = useWorld((world) => world.robots);
  const pending = useStopping((state) => state.pending);
  const stopped = stoppedRobots(robots);
  return (
    <div className={css.banners} role="status" aria-live="assertive">
      {pending && (
        <p className={css.pending} data-failed={pending.failed}>
          {pending.failed ? t('notSent') : t('sending')}
        </p>
      )}
      {stopped.map((robot) => (
        <Stopped key={robot.name} robot={robot} />
      ))}
    </div>
  );
}

const ORDER = ['sent', 'received', 'at_rest'] as const;

function Stopped({ robot }: { robot: RobotView }) {
  const { t, i18n } = useTranslation(['stop', 'common']);
  const [asking, setAsking] = useState(false);
  const reset = useStopping((state) => state.reset);
  const { state, sent_unix_ms: sentMs, at_rest_unix_ms: restMs } = robot.stop;
  const reached = ORDER.findIndex((one) => one === state);
  const times = { sent: sentMs, received: 0, at_rest: restMs };
  return (
    <div className={css.banner} data-overdue={state === 'overdue'}>
      <p className={css.text}>
        <Icon name="octagon" />
        <strong>{t('banner', { name: robot.name })}</strong>
      </p>
      {state === 'overdue' && <p className={css.overdue}>{t('overdue')}</p>}
      {reached >= 0 && (
        <ul className={css.progress}>
          {ORDER.map((one, index) => (
            <li key={one} data-reached={index <= reached}>
              <Icon name={index <= reached ? 'check' : 'dots'} size={16} />
              {t(one, { name: robot.name })}
              {index <= reached && times[one] > 0 && <span>{clockTime(times[one], i18n.language, true)}</span>}
            </li>
          ))}
        </ul>
      )}
      <Button onPress={() => setAsking(true)}>{t('reset')}</Button>
      <Dialog
        role="alertdialog"
        title={t('resetTitle', { name: robot.name })}
        isOpen={asking}
        onClose={() => setAsking(false)}
      >
        <p>{t('resetText', { name: robot.name })}</p>
        <DialogButtons>
          <Button autoFocus onPress={() => setAsking(false)}>
            {t('common:cancel')}
          </Button>
          <Button
            tone="main"
            onPress={() => {
              setAsking(false);
              void attempt(() => reset([robot.name]));
            }}
          >
            {t('resetYes')}
          </Button>
        </DialogButtons>
      </Dialog>
    </div>
  );
}
