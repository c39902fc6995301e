import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getIncidents } from '@/live/api';
import { useWorld } from '@/live/store';
import { useRobotNames } from '@/state/selection';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty, Loading, Panel } from '@/ui/panel';
import { useRequest } from '@/ui/use-request';

import { IncidentCard } from './incident-card';
import css from './incidents.module.css';
import { merged } from './telling';

const ALL = '*';

/** What went wrong, what was tried, and how it ended; newest first. */
export function IncidentsPage() {
  const { t } = useTranslation(['incidents', 'common']);
  const [chosen, setChosen] = useState(ALL);
  const [asked, setAsked] = useState(0);
  const names = useRobotNames();
  const live = useWorld((world) => world.incidents);
  const robot = chosen === ALL ? '' : chosen;
  const run = useWorld((world) => world.run);
  const fetched = useRequest([run, asked, robot].join('\n'), () => getIncidents(robot));
  const shown = merged(fetched.state === 'ready' ? fetched.value : [], Object.values(live), robot);
  const filter = names.length > 1 && (
    <Choice
      label={t('which')}
      hideLabel
      value={chosen}
      options={[{ id: ALL, label: t('all') }, ...names.map((name) => ({ id: name, label: name }))]}
      onChange={setChosen}
    />
  );
  return (
    <Panel title={t('title')} tools={filter}>
      {fetched.state === 'loading' && shown.length === 0 && <Loading />}
      {fetched.state === 'failed' && (
        <Empty title={t('failed')}>
          <p role="alert">{fetched.reason}</p>
          <Button onPress={() => setAsked(asked + 1)}>{t('common:tryAgain')}</Button>
        </Empty>
      )}
      {fetched.state === 'ready' && shown.length === 0 && (
        <Empty title={t('empty')}>
          <p>{t('emptyText')}</p>
        </Empty>
      )}
      <ul className={css.list}>
        {shown.map((incident) => (
          <IncidentCard key={incident.id} incident={incident} />
        ))}
      </ul>
    </Panel>
  );
}
