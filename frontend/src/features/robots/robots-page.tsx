import { useTranslation } from 'react-i18next';

import { useLive, useWorld } from '@/live/store';
import { useOverlays } from '@/state/overlays';
import { Button } from '@/ui/button';
import { Empty, Loading, Panel } from '@/ui/panel';

import { RobotCard } from './robot-card';
import css from './robots.module.css';

/** All robots: how they are, and what they can do. */
export function RobotsPage() {
  const { t } = useTranslation(['robots', 'common']);
  const known = useLive((live) => live.world.run !== '');
  const robots = useWorld((world) => world.robots);
  const open = useOverlays((state) => state.set);
  const sorted = Object.values(robots).sort((a, b) => a.name.localeCompare(b.name));
  const add = (
    <Button needs="setting" tone="quiet" icon="plus" onPress={() => open('addRobot')}>
      {t('add')}
    </Button>
  );
  return (
    <Panel title={t('title')} tools={add}>
      {!known && <Loading />}
      {known && sorted.length === 0 && (
        <Empty title={t('empty')}>
          <p>{t('emptyText')}</p>
        </Empty>
      )}
      <ul className={css.list}>
        {sorted.map((robot) => (
          <RobotCard key={robot.name} robot={robot} />
        ))}
      </ul>
    </Panel>
  );
}
