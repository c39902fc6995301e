import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { RobotView } from '@/live/types';
import { stoppedRobots, useStopping } from '@/state/stopping';
import { Button } from '@/ui/button';
import { Icon } from '@/ui/icon';
import { clockTime, nameList } from '@/ui/words';

import { Release } from './release';
import css from './stop.module.css';

/** So many are told of one by one; more would leave no room for the rest of the page. */
const SINGLY = 2;

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
      {stopped.length > SINGLY ? (
        <Many robots={stopped} />
      ) : (
        stopped.map((robot) => <Stopped key={robot.name} robot={robot} />)
      )}
    </div>
  );
}

/** Many stopped robots in one banner, and each when wanted. */
function Many({ robots }: { robots: readonly RobotView[] }) {
  const { t, i18n } = useTranslation('stop');
  const [each, setEach] = useState(false);
  const resting = robots.filter((robot) => robot.stop.state === 'at_rest').length;
  const doubtful = robots.filter((robot) => robot.stop.state === 'overdue').map((robot) => robot.name);
  return (
    <>
      <div className={css.banner} data-overdue={doubtful.length > 0}>
        <p className={css.text}>
          <Icon name="octagon" />
          <strong>{t('bannerMany', { count: robots.length })}</strong>
        </p>
        {doubtful.length > 0 && (
          <p className={css.overdue}>{t('overdueMany', { names: nameList(doubtful, i18n.language) })}</p>
        )}
        <p className={css.resting}>{t('resting', { resting, all: robots.length })}</p>
        <div className={css.deeds}>
          <Button icon={each ? 'up' : 'down'} aria-expanded={each} onPress={() => setEach(!each)}>
            {t('each')}
          </Button>
          <Release names={robots.map((robot) => robot.name)} label={t('resetAll')} />
        </div>
      </div>
      {each && (
        <div className={css.each}>
          {robots.map((robot) => (
            <Stopped key={robot.name} robot={robot} />
          ))}
        </div>
      )}
    </>
  );
}

const ORDER = ['sent', 'received', 'at_rest'] as const;

function Stopped({ robot }: { robot: RobotView }) {
  const { t, i18n } = useTranslation('stop');
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
      <Release names={[robot.name]} label={t('reset')} />
    </div>
  );
}
