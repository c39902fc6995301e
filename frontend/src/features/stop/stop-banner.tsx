import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { RobotView } from '@/live/types';
import { type StoppedRobot, stoppedRobots, useStopping } from '@/state/stopping';
import { Button } from '@/ui/button';
import { Icon } from '@/ui/icon';
import { useLayout } from '@/ui/use-media';
import { clockTime, nameList } from '@/ui/words';

import { Release } from './release';
import css from './stop.module.css';

/** So many are told of one by one; more would leave no room for the rest of the page. */
const SINGLY = { phone: 1, tablet: 2, desktop: 2 };

/** What became of a stop, robot by robot, and the way out of it. */
export function StopBanner() {
  const robots = useWorld((world) => world.robots);
  const answer = useStopping((state) => state.answer);
  const stopped = stoppedRobots(robots, answer);
  const layout = useLayout();
  return (
    <div className={css.banners} role="status" aria-live="assertive">
      <Pending />
      {answer?.kept === false && <NotKept />}
      <Troubled />
      {stopped.length > SINGLY[layout] ? (
        <Many robots={stopped} />
      ) : (
        stopped.map((robot) => <Stopped key={robot.name} robot={robot} />)
      )}
    </div>
  );
}

/** A stop of this page that the server has not taken. */
function Pending() {
  const { t } = useTranslation('stop');
  const pending = useStopping((state) => state.pending);
  const callOff = useStopping((state) => state.callOff);
  if (!pending) return null;
  return (
    <p className={css.pending} data-failed={pending.state !== 'sending'}>
      <span>{t(pending.state)}</span>
      {pending.state === 'late' && <Button onPress={callOff}>{t('callOff')}</Button>}
    </p>
  );
}

function NotKept() {
  const { t } = useTranslation('stop');
  return (
    <p className={css.pending} data-failed>
      {t('notKept')}
    </p>
  );
}

/** Robots that somebody has to go and look after. */
function Troubled() {
  const { t } = useTranslation('stop');
  const robots = useWorld((world) => world.robots);
  return Object.values(robots).map((robot) => {
    const trouble = robot.connection === 'here' ? robot.trouble : lostUnderWay(robot);
    return (
      trouble && (
        <p key={robot.name} className={css.pending} data-failed>
          {t(`trouble.${trouble}`, { name: robot.name })}
        </p>
      )
    );
  });
}

/** Whether it may have been driving when it was heard last; of one that is stopped the stop tells. */
function lostUnderWay({ connection, state, at_rest, stop }: RobotView) {
  return connection === 'lost' && stop.state === 'none' && (state === 'running' || at_rest === false) && 'lost';
}

/** Many stopped robots in one banner, and each when wanted. */
function Many({ robots }: { robots: readonly StoppedRobot[] }) {
  const { t, i18n } = useTranslation('stop');
  const [each, setEach] = useState(false);
  const names = (fate: StoppedRobot['fate']) => robots.filter((robot) => robot.fate === fate).map((robot) => robot.name);
  const unheard = (release: (typeof UNHEARD)[number]) =>
    robots.filter((robot) => robot.stop.release === release).map((robot) => robot.name);
  const doubtful = DOUBTFUL.map((fate) => [fate, names(fate)] as const).filter(([, named]) => named.length > 0);
  return (
    <>
      <div className={css.banner} data-overdue={doubtful.length > 0}>
        <p className={css.text}>
          <Icon name="octagon" />
          <strong>{t('bannerMany', { count: robots.length })}</strong>
        </p>
        {doubtful.map(([fate, named]) => (
          <p key={fate} className={css.overdue}>
            {t(`${fate}Many`, { names: nameList(named, i18n.language) })}
          </p>
        ))}
        {UNHEARD.map((release) => [release, unheard(release)] as const).map(
          ([release, named]) =>
            named.length > 0 && (
              <p key={release} className={css.overdue}>
                {t(`release.${release}`, { name: nameList(named, i18n.language) })}
              </p>
            ),
        )}
        <p className={css.resting}>{t('resting', { resting: names('stands').length, all: robots.length })}</p>
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

const DOUBTFUL = ['moves', 'silent'] as const;
const UNHEARD = ['sent', 'lost'] as const;

/** One of three things is said of each: it stands, it does not, it does not answer; before that, that it was told. */
function Stopped({ robot: { name, fate, stop } }: { robot: StoppedRobot }) {
  const { t, i18n } = useTranslation('stop');
  const isDoubtful = fate === 'moves' || fate === 'silent';
  return (
    <div className={css.banner} data-overdue={isDoubtful}>
      <p className={css.text}>
        <Icon name="octagon" />
        <strong>{t('banner', { name })}</strong>
      </p>
      {isDoubtful ? (
        <p className={css.overdue}>{t(fate, { name })}</p>
      ) : (
        <p className={css.fate} data-stands={fate === 'stands'}>
          <Icon name={fate === 'stands' ? 'check' : 'dots'} size={16} />
          {t(fate)}
          {fate === 'stands' && stop.at_rest_unix_ms > 0 && (
            <span>{clockTime(stop.at_rest_unix_ms, i18n.language, true)}</span>
          )}
        </p>
      )}
      {stop.release !== 'none' && <p className={css.overdue}>{t(`release.${stop.release}`, { name })}</p>}
      <Release names={[name]} label={t('reset')} />
    </div>
  );
}
