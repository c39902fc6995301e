import { useTranslation } from 'react-i18next';

import { removeRobot } from '@/live/api';
import { useWorld } from '@/live/store';
import type { RobotView } from '@/live/types';
import { attempt } from '@/state/do';
import { useOverlays } from '@/state/overlays';
import { Button } from '@/ui/button';
import { Empty, Panel } from '@/ui/panel';
import { inWords } from '@/ui/words';

import css from './robots.module.css';

/** All robots, and what they can do. */
export function RobotsPage() {
  const { t } = useTranslation('robots');
  const robots = useWorld((world) => world.robots);
  const open = useOverlays((state) => state.set);
  const sorted = Object.values(robots).sort((a, b) => a.name.localeCompare(b.name));
  const add = (
    <Button tone="quiet" icon="plus" onPress={() => open('addRobot')}>
      {t('add')}
    </Button>
  );
  return (
    <Panel title={t('title')} tools={add}>
      {sorted.length === 0 && <Empty title={t('empty')} />}
      <ul className={css.list}>
        {sorted.map((robot) => (
          <Robot key={robot.name} robot={robot} />
        ))}
      </ul>
    </Panel>
  );
}

function Robot({ robot }: { robot: RobotView }) {
  const { t } = useTranslation('robots');
  return (
    <li className={css.robot}>
      <div className={css.head}>
        <h3>{robot.name}</h3>
        <p>
          {t(`connection.${robot.connection}`)} · {t(`state.${robot.state}`)}
          {typeof robot.battery === 'number' && ` · ${t('battery', { percent: Math.round(robot.battery * 100) })}`}
        </p>
      </div>
      {robot.catalogue.length > 0 && (
        <details>
          <summary>{t('can')}</summary>
          <ul className={css.actions}>
            {robot.catalogue.map((action) => (
              <li key={action.name}>
                <strong>{inWords(action.name)}</strong> {action.description}
              </li>
            ))}
          </ul>
        </details>
      )}
      {robot.connection !== 'here' && (
        <Button onPress={() => void attempt(() => removeRobot(robot.name))}>{t('remove', { name: robot.name })}</Button>
      )}
    </li>
  );
}
