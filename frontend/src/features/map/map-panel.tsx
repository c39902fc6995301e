import { useContext, useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getRules } from '@/live/api';
import { useWorld } from '@/live/store';
import type { MapInfo, Rule } from '@/live/types';
import { useAsked } from '@/state/asked';
import { useRobotNames, useSelection } from '@/state/selection';
import { Beside, Button } from '@/ui/button';
import type { Corner } from '@/ui/corners';
import { Choice } from '@/ui/choice';
import { Empty, Loading, Panel } from '@/ui/panel';
import { useMap, type Shown } from '@/ui/use-map';
import { useLayout } from '@/ui/use-media';
import { useNow } from '@/ui/use-now';
import { useKept, useRequest } from '@/ui/use-request';
import { ago } from '@/ui/words';

import type { Rover } from './map-drawing';
import { MapList } from './map-list';
import { MapStage } from './map-stage';
import css from './map.module.css';
import { candidatesOf, type Mark } from './marks';
import { areaOfMark, roomOf, type Area } from './areas';
import { DrawBar } from './draw-bar';
import { PlaceBar } from './place-bar';
import { drawn as drawnOn, shownOf, type Draft } from './place-draft';
import { useEdits } from './place-edits';
import { FoundOffer } from './found-offer';
import { PlacesBar } from './places-bar';
import { useTrails } from './use-trails';
import { useProposedWay, useWayTo } from './use-way';

const AGE_STEP_MS = 1000;

/** Where robots are and what stands around them. */
export function MapPanel() {
  const { t } = useTranslation(['map', 'common']);
  const names = useRobotNames();
  const selected = useSelection()[0] ?? '';
  const [picked, setPicked] = useState('');
  const [listed, setListed] = useState(false);
  const [asked, setAsked] = useState(0);
  const known = useWorld((world) => world.run !== '');
  const isBeside = useContext(Beside); // then the conversation says whose it is
  const robot = !isBeside && names.includes(picked) ? picked : selected;
  const [placing, setPlacing] = useState(false);
  const edits = useEdits((done) => done.count);
  const mapName = useWorld((world) => world.views[robot]?.map_name ?? '');
  const places = useWorld((world) => world.views[robot]?.places ?? '');
  const shown = useMap(robot, `${mapName}\n${places}`, asked + edits);
  const isNarrow = useIsNarrow();
  const said = (name: string) => (isNarrow ? { iconOnly: true, 'aria-label': name } : {});
  const tools = (
    <>
      {names.length > 1 && !isBeside && (
        <Choice
          label={t('whose')}
          hideLabel
          value={robot}
          options={names.map((name) => ({ id: name, label: name }))}
          onChange={setPicked}
        />
      )}
      <Button needs="map" tone="quiet" icon="edit" {...said(t('places.mode'))} aria-pressed={placing} isDisabled={shown.state !== 'ready'} onPress={() => setPlacing(!placing)}>
        {t('places.mode')}
      </Button>
      <Button tone="quiet" icon="plan" {...said(t('asList'))} aria-pressed={listed} isDisabled={shown.state !== 'ready'} onPress={() => setListed(!listed)}>
        {t('asList')}
      </Button>
    </>
  );
  return (
    <Panel title={t('title')} tools={tools} flush>
      {robot === '' && (known ? <Empty title={t('noRobot')} /> : <Loading />)}
      {robot !== '' && shown.state !== 'ready' && <NotYet shown={shown} onRetry={() => setAsked(asked + 1)} />}
      {shown.state === 'ready' && (
        <Ready key={mapName} map={shown.map} mapName={mapName} robot={robot} listed={listed} placing={placing}>
          {shown.sinceUnixMs > 0 && <Old sinceUnixMs={shown.sinceUnixMs} />}
        </Ready>
      )}
    </Panel>
  );
}

/** Whether buttons have room for their signs only. */
function useIsNarrow(): boolean {
  const isBeside = useContext(Beside);
  return useLayout() === 'phone' || isBeside;
}

function NotYet({ shown, onRetry }: { shown: Exclude<Shown, { state: 'ready' }>; onRetry: () => void }) {
  const { t } = useTranslation(['map', 'common']);
  if (shown.state !== 'failed') return <Loading />;
  return (
    <Empty title={t('empty')}>
      {shown.reason && <p>{shown.reason}</p>}
      <Button onPress={onRetry}>{t('common:tryAgain')}</Button>
    </Empty>
  );
}

/** Says that what is shown may not be so any more. */
function Old({ sinceUnixMs }: { sinceUnixMs: number }) {
  const { t, i18n } = useTranslation('map');
  const now = useNow(AGE_STEP_MS);
  return (
    <p className={css.old}>{t('old', { ago: ago(now - sinceUnixMs, i18n.language) })}</p>
  );
}

interface ReadyProps {
  map: MapInfo;
  mapName: string;
  robot: string;
  listed: boolean;
  /** Whether rooms and things are put on the map rather than robots sent there. */
  placing: boolean;
  children: React.ReactNode;
}

function Ready({ map, mapName, robot, listed, placing, children }: ReadyProps) {
  const { t } = useTranslation('map');
  const [marked, setMarked] = useState<Mark | null>(null);
  const way = useWayTo(robot, marked);
  const proposed = useProposedWay(robot);
  const asked = useAsked();
  const question = asked.findLast((entry) => entry.targets.includes(robot));
  const candidates = useMemo(() => candidatesOf(map, question), [map, question]);
  const trials = useMemo(() => [proposed, way], [proposed, way]);
  const rovers = useRovers(mapName, robot);
  const trails = useTrails(mapName);
  const rules = useRules();
  const zones = useMemo(() => zonesOf(rules, mapName), [rules, mapName]);
  const wished = useMemo(() => zonesOf(asked.flatMap((entry) => entry.rules), mapName), [asked, mapName]);
  const nameFor = (room: string) => (room ? t('partOf', { room }) : t('anArea'));
  const [area, setArea] = useState<Area | null>(null);
  const [drafted, setDraft] = useState<Draft | null>(null);
  const draft = placing ? drafted : null;
  const onDraw = (corners: readonly Corner[] | null) => setArea(corners && { corners, name: nameFor(roomOf(map, corners)) });
  const onRule = (mark: Mark) => setArea(areaOfMark(mark));
  const onPlace = (corners: readonly Corner[] | null) => draft && corners && setDraft(drawnOn(draft, corners));
  const { corners: drawn = null } = area ?? {};
  const shape = draft ? shownOf(draft) : placing ? null : drawn;
  return (
    <div className={css.layout}>
      {children}
      <MapStage map={map} rovers={rovers} trails={trails} zones={zones} wished={wished} marked={marked} trials={trials} candidates={candidates} onMark={setMarked} drawn={shape} onDraw={placing ? onPlace : onDraw} canRule={!placing} />
      {listed && <MapList map={map} rovers={rovers} onMark={setMarked} />}
      <FoundOffer map={map} />
      {placing ? (
        <PlacesBar map={map} marked={marked} draft={draft} onDraft={setDraft} onClear={() => setMarked(null)} />
      ) : area ? (
        <DrawBar area={area} mapName={mapName} rules={rules} onDone={() => setArea(null)} />
      ) : (
        <PlaceBar robot={robot} marked={marked} way={way} question={question} candidates={candidates} rooms={map.rooms} onClear={() => setMarked(null)} onRule={onRule} />
      )}
    </div>
  );
}

const NO_RULES: readonly Rule[] = [];

/** All rules; none where nobody keeps any. */
function useRules(): readonly Rule[] {
  const { i18n } = useTranslation();
  const known = useWorld((world) => world.info?.modules?.rules ?? false);
  const changes = useWorld((world) => world.ruleChanges);
  const found = useKept(useRequest(known ? `zones\n${changes}` : '', () => getRules(i18n.language)));
  return useMemo(() => (found.state === 'ready' ? (found.value.rules ?? []).map((view) => view.rule) : NO_RULES), [found]);
}

/** Those that hold for a part of a map. */
const zonesOf = (rules: readonly Rule[], mapName: string) =>
  rules.filter((rule) => (rule.rectangle ?? rule.polygon) && (!rule.map || rule.map === mapName));

/** The robots that share a map, the chosen one last, so that it is drawn over the others. */
function useRovers(mapName: string, robot: string): readonly Rover[] {
  const views = useWorld((world) => world.views);
  const robots = useWorld((world) => world.robots);
  const { t } = useTranslation('map');
  return useMemo(() => {
    const rovers = Object.values(robots).flatMap((one): Rover[] => {
      const view = views[one.name] ?? null;
      const pose = view?.pose ?? one.pose;
      const sameMap = one.name === robot || (view?.map_name ?? one.map_name) === mapName;
      return pose && sameMap
        ? [{ name: one.name, title: view?.holds ? t('holding', { robot: one.name, thing: view.holds }) : '', pose, view, chosen: one.name === robot, here: one.connection === 'here' }]
        : [];
    });
    return rovers.sort((a, b) => Number(a.chosen) - Number(b.chosen));
  }, [views, robots, mapName, robot, t]);
}
