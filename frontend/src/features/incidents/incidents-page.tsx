import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { Incident } from '@/live/types';
import { Empty, Panel } from '@/ui/panel';
import { clockTime, dayName } from '@/ui/words';

import css from './incidents.module.css';

/** What went wrong, what was tried, and how it ended; newest first. */
export function IncidentsPage() {
  const { t } = useTranslation('incidents');
  const incidents = useWorld((world) => world.incidents);
  const sorted = Object.values(incidents).sort((a, b) => b.opened_unix_ms - a.opened_unix_ms);
  return (
    <Panel title={t('title')}>
      {sorted.length === 0 && <Empty title={t('empty')} />}
      <ul className={css.list}>
        {sorted.map((incident) => (
          <Item key={incident.id} incident={incident} />
        ))}
      </ul>
    </Panel>
  );
}

function Item({ incident }: { incident: Incident }) {
  const { t, i18n } = useTranslation('incidents');
  const at = incident.opened_unix_ms;
  return (
    <li className={css.item} data-ending={incident.ending}>
      <p className={css.head}>
        <strong>{incident.robot}</strong>
        <span>
          {dayName(at, at, i18n.language)} {clockTime(at, i18n.language)}
        </span>
        <span>{t(`ending.${incident.ending}`)}</span>
      </p>
      <p>{incident.message}</p>
      <ul>
        {incident.attempts.map((attempt) => (
          <li key={attempt.unix_ms}>
            {attempt.asked && <p>{t('asked', { asked: attempt.asked })}</p>}
            {attempt.answered && <p>{t('answered', { answered: attempt.answered })}</p>}
            {attempt.tried && <p>{t('tried', { tried: attempt.tried })}</p>}
          </li>
        ))}
      </ul>
    </li>
  );
}
