import { useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getMap } from '@/live/api';
import { useWorld } from '@/live/store';
import type { MapInfo, MapThing } from '@/live/types';
import { useRobotNames, useSelection } from '@/state/selection';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty, Panel } from '@/ui/panel';
import { useRequest } from '@/ui/use-request';

import type { Rover } from './map-drawing';
import { MapList } from './map-list';
import { MapStage } from './map-stage';
import css from './map.module.css';
import { PlaceBar } from './place-bar';
import type { Place } from './viewport';

/** Where robots are and what stands around them. */
export function MapPanel() {
  const { t } = useTranslation(['map', 'common']);
  const names = useRobotNames();
  const selected = useSelection()[0] ?? '';
  const [picked, setPicked] = useState('');
  const [listed, setListed] = useState(false);
  const [asked, setAsked] = useState(0);
  const robot = names.includes(picked) ? picked : selected;
  const mapName = useWorld((world) => world.views[robot]?.map_name ?? '');
  // A robot that appears, or changes to another map, is asked anew.
  const map = useRequest(robot && [robot, mapName, asked].join('\n'), () => getMap(robot));
  const tools = (
    <>
      {names.length > 1 && (
        <Choice
          label={t('whose')}
          hideLabel
          value={robot}
          options={names.map((name) => ({ id: name, label: name }))}
          onChange={setPicked}
        />
      )}
      <Button tone="quiet" icon="plan" aria-pressed={listed} isDisabled={map.state !== 'ready'} onPress={() => setListed(!listed)}>
        {t('asList')}
      </Button>
    </>
  );
  return (
    <Panel title={t('title')} tools={tools} flush>
      {robot === '' && <Empty title={t('noRobot')} />}
      {robot !== '' && map.state === 'loading' && (
        <Empty title={t('common:loading')} />
      )}
      {map.state === 'failed' && (
        <Empty title={t('empty')}>
          {map.reason && <p>{map.reason}</p>}
          <Button onPress={() => setAsked(asked + 1)}>{t('common:tryAgain')}</Button>
        </Empty>
      )}
      {map.state === 'ready' && <Ready key={mapName} map={map.value} mapName={mapName} robot={robot} listed={listed} />}
    </Panel>
  );
}

function Ready({ map, mapName, robot, listed }: { map: MapInfo; mapName: string; robot: string; listed: boolean }) {
  const [marked, setMarked] = useState<Place | MapThing | null>(null);
  const rovers = useRovers(mapName, robot);
  return (
    <div className={css.layout}>
      <MapStage map={map} rovers={rovers} marked={marked} onMark={setMarked} />
      {listed && <MapList map={map} rovers={rovers} onMark={setMarked} />}
      <PlaceBar marked={marked} onClear={() => setMarked(null)} />
    </div>
  );
}

/** The robots that share a map, the chosen one last, so that it is drawn over the others. */
function useRovers(mapName: string, robot: string): readonly Rover[] {
  const views = useWorld((world) => world.views);
  const robots = useWorld((world) => world.robots);
  return useMemo(() => {
    const rovers = Object.values(robots).flatMap((one): Rover[] => {
      const view = views[one.name] ?? null;
      const pose = view?.pose ?? one.pose;
      const sameMap = one.name === robot || (view?.map_name ?? one.map_name) === mapName;
      return pose && sameMap
        ? [{ name: one.name, pose, view, chosen: one.name === robot, here: one.connection === 'here' }]
        : [];
    });
    return rovers.sort((a, b) => Number(a.chosen) - Number(b.chosen));
  }, [views, robots, mapName, robot]);
}
