import { useTranslation } from 'react-i18next';

import { removeRobot } from '@/live/api';
import { onServerClock } from '@/live/server-time';
import type { RobotView } from '@/live/types';
import { attempt } from '@/state/do';
import { useMood } from '@/state/mood';
import { useSelectionStore } from '@/state/selection';
import { Button } from '@/ui/button';
import { Dot } from '@/ui/dot';
import { PolicyChoice } from '@/ui/policy-choice';
import { goTo } from '@/ui/use-hash';
import { useNow } from '@/ui/use-now';
import { ago } from '@/ui/words';

import { Abilities } from './abilities';
import css from './robots.module.css';

const SEEN_STEP_MS = 10_000;

/** One robot. */
export function RobotCard({ robot }: { robot: RobotView }) {
  const { t } = useTranslation('robots');
  const only = useSelectionStore((state) => state.only);
  const here = robot.connection === 'here';
  const mood = useMood(robot.name);
  const talk = () => {
    only(robot.name);
    goTo('/');
  };
  return (
    <li className={css.robot}>
      <div className={css.head}>
        <h3>{robot.name}</h3>
        <Button icon="chat" onPress={talk}>
          {t('talk', { name: robot.name })}
        </Button>
        {!here && (
          <Button needs="setting" icon="trash" onPress={() => void attempt(() => removeRobot(robot.name))}>
            {t('remove', { name: robot.name })}
          </Button>
        )}
      </div>
      <dl className={css.facts}>
        <div>
          <dt>{t('now')}</dt>
          <dd className={css.state} data-connection={robot.connection}>
            <Dot mood={mood} />
            {mood === 'away' ? t(`connection.${robot.connection}`) : t(`state.${mood}`)}
          </dd>
        </div>
        {robot.stop.state !== 'none' && (
          <div>
            <dt>{t('stop')}</dt>
            <dd className={css.stopped}>{t('stopped')}</dd>
          </div>
        )}
        {typeof robot.battery === 'number' && <Battery level={robot.battery} />}
        {!here && robot.last_seen_unix_ms > 0 && <LastSeen unixMs={robot.last_seen_unix_ms} />}
      </dl>
      <PolicyChoice robot={robot.name} />
      <Abilities robot={robot} />
    </li>
  );
}

const LOW = 0.2;

function Battery({ level }: { level: number }) {
  const { t } = useTranslation('robots');
  const percent = Math.round(level * 100);
  return (
    <div>
      <dt>{t('battery')}</dt>
      <dd className={css.battery} data-low={level < LOW}>
        <meter min={0} max={100} low={LOW * 100} value={percent} aria-label={t('battery')} />
        {t('percent', { percent })}
      </dd>
    </div>
  );
}

function LastSeen({ unixMs }: { unixMs: number }) {
  const { t, i18n } = useTranslation('robots');
  const now = useNow(SEEN_STEP_MS);
  return (
    <div>
      <dt>{t('lastSeen')}</dt>
      <dd>{ago(onServerClock(now) - unixMs, i18n.language)}</dd>
    </div>
  );
}
