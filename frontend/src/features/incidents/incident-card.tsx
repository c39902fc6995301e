import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { Incident } from '@/live/types';
import { useMoment } from '@/state/moment';
import { useSelectionStore } from '@/state/selection';
import { Button } from '@/ui/button';
import { Icon, type IconName } from '@/ui/icon';
import { goTo } from '@/ui/use-hash';
import { useNow } from '@/ui/use-now';
import { clockTime, dayAndTime } from '@/ui/words';

import css from './incidents.module.css';
import { stepInWords } from './telling';

const MINUTE_MS = 60_000;

type Ending = Incident['ending'] | 'left';

const signs: Record<Ending, IconName> = {
  open: 'bang',
  held: 'question',
  solved: 'check',
  skipped: 'skip',
  cancelled: 'cross',
  replaced: 'right',
  left: 'cross',
};

/** What happened to one step, as a short story. */
export function IncidentCard({ incident }: { incident: Incident }) {
  const { t, i18n } = useTranslation('incidents');
  const now = useNow(MINUTE_MS);
  const only = useSelectionStore((state) => state.only);
  const showMoment = useMoment((state) => state.show);
  const opened = incident.opened_unix_ms;
  const ending = useEnding(incident);
  const toChat = () => {
    only(incident.robot);
    showMoment(opened);
    goTo('/');
  };
  return (
    <li className={css.item} data-ending={ending}>
      <p className={css.head}>
        <strong>{incident.robot}</strong>
        <time dateTime={new Date(opened).toISOString()}>{dayAndTime(opened, now, i18n.language)}</time>
        <span className={css.ending}>
          <Icon name={signs[ending]} size={16} />
          {t(`ending.${ending}`)}
        </span>
      </p>
      <h3>{incident.message || t('unsaid')}</h3>
      <p className={css.step}>{t('step', { step: stepInWords(incident) })}</p>
      {incident.attempts.length > 0 && (
        <ol className={css.attempts}>
          {incident.attempts.map((attempt, index) => (
            <li key={`${attempt.unix_ms} ${index}`}>
              <time>{clockTime(attempt.unix_ms, i18n.language)}</time>
              <div>
                {attempt.asked && <p>{t('asked', { robot: incident.robot, asked: attempt.asked })}</p>}
                {attempt.answered && <p>{t('answered', { answered: attempt.answered })}</p>}
                {attempt.tried && <p>{t('tried', { tried: attempt.tried })}</p>}
                {!attempt.asked && !attempt.answered && !attempt.tried && <p>{t('alone')}</p>}
              </div>
            </li>
          ))}
        </ol>
      )}
      {incident.note && <p className={css.step}>{incident.note}</p>}
      <div className={css.foot}>
        {incident.closed_unix_ms > 0 && (
          <span>{t('closed', { time: dayAndTime(incident.closed_unix_ms, now, i18n.language) })}</span>
        )}
        <Button tone="quiet" icon="chat" onPress={toChat}>
          {t('inChat')}
        </Button>
      </div>
    </li>
  );
}

/** How it ended; what waited for help does so only as long as its plan does. */
function useEnding({ ending, graph_name }: Incident): Ending {
  const waits = useWorld(({ plans }) => Object.values(plans).some((plan) => plan.graph_name === graph_name && (plan.state === 'held' || plan.state === 'paused')));
  return ending === 'held' && !waits ? 'left' : ending;
}
