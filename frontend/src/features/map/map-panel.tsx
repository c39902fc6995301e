import { useTranslation } from 'react-i18next';

import { getMap } from '@/live/api';
import { useWorld } from '@/live/store';
import type { MapInfo } from '@/live/types';
import { useSelection } from '@/state/selection';
import { Empty, Panel } from '@/ui/panel';
import { useRequest } from '@/ui/use-request';

import css from './map.module.css';

/** Where the first of the chosen robots is. */
export function MapPanel() {
  const { t } = useTranslation(['map', 'common']);
  const [robot = ''] = useSelection();
  const map = useRequest(robot, getMap);
  return (
    <Panel title={robot ? t('of', { robot }) : t('title')}>
      {robot === '' && <Empty title={t('noRobot')} />}
      {robot !== '' && map.state === 'loading' && <p>{t('common:loading')}</p>}
      {map.state === 'failed' && <Empty title={t('empty')}>{map.reason && <p>{map.reason}</p>}</Empty>}
      {map.state === 'ready' && <Drawn map={map.value} robot={robot} />}
    </Panel>
  );
}

function Drawn({ map, robot }: { map: MapInfo; robot: string }) {
  const { t } = useTranslation(['map', 'common']);
  const pose = useWorld((world) => world.views[robot]?.pose ?? world.robots[robot]?.pose ?? null);
  const x = pose ? (pose.x - map.origin.x) / map.resolution : 0;
  const y = pose ? map.height - (pose.y - map.origin.y) / map.resolution : 0;
  const size = Math.max(map.width, map.height) / 40;
  return (
    <svg className={css.map} viewBox={`0 0 ${map.width} ${map.height}`} role="img" aria-label={t('alt', { robot })}>
      <image href={`data:image/png;base64,${map.image}`} width={map.width} height={map.height} />
      {pose && (
        <g transform={`translate(${x} ${y}) rotate(${(-(pose.yaw ?? 0) * 180) / Math.PI}) scale(${size})`}>
          <circle r={1} className={css.robot} />
          <path d="M0 0 L1.6 0" className={css.nose} />
        </g>
      )}
    </svg>
  );
}
