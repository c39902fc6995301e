import { useMemo, useState } from 'react';
import { ToggleButton } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { MapInfo, Rule } from '@/live/types';
import { Button } from '@/ui/button';
import { cornerAt, type Corner } from '@/ui/corners';
import { Icon, type IconName } from '@/ui/icon';

import { MapDrawing, type Rover } from './map-drawing';
import { markAt, type Candidates, type Mark } from './marks';
import type { Trails } from './use-trails';
import type { Way } from './use-way';
import css from './map.module.css';
import { useViewport } from './use-viewport';
import type { Place } from './viewport';

interface Props {
  map: MapInfo;
  rovers: readonly Rover[];
  trails: Trails;
  zones: readonly Rule[];
  wished: readonly Rule[];
  marked: Mark | null;
  trials: readonly Way[];
  candidates: Candidates;
  onMark: (marked: Mark) => void;
  /** The corners of an area that is being drawn; null: none is. */
  drawn: readonly Corner[] | null;
  onDraw: (corners: readonly Corner[] | null) => void;
  /** Whether areas for rules can be drawn. */
  canRule: boolean;
}

const ZOOM_STEP = 1.4;
const FINGER_PX = 14;

/** The map to look at, move, zoom and point at. */
export function MapStage({ map, rovers, trails, zones, wished, marked, trials, candidates, onMark, drawn, onDraw, canRule }: Props) {
  const { t } = useTranslation('map');
  const [follow, setFollow] = useState(false);
  const [showScan, setShowScan] = useState(false);
  const chosen = rovers.find((rover) => rover.chosen) ?? null;
  const { x, y } = chosen?.pose ?? { x: 0, y: 0 };
  const followed = useMemo(() => (follow && chosen ? { x, y } : null), [follow, chosen, x, y]);
  const drawing = drawn !== null;
  const onPick = (place: Place) => (drawn ? onDraw([...drawn, cornerAt(place)]) : onMark(markAt(map, place, FINGER_PX / view.scale, marked)));
  // While the finger is down nothing around the map may move.
  const [dragged, setDragged] = useState<readonly Corner[] | null>(null);
  const onDrag = (ends: readonly [Place, Place] | null, isOver: boolean) => {
    const corners = ends && ends.map(cornerAt);
    setDragged(isOver ? null : corners);
    if (isOver && corners) onDraw(corners);
  };
  const { box, size, view, zoomBy, fitAll, handlers } = useViewport({
    map,
    followed,
    onMoved: () => setFollow(false),
    onPick,
    onDrag: drawing ? onDrag : null,
  });
  const senses = rovers.some((rover) => (rover.view?.scan.length ?? 0) > 0);
  return (
    <div className={css.frame}>
      <div
        ref={box}
        className={css.stage}
        role="application"
        aria-label={t(drawing ? 'drawHelp' : 'help', { robot: chosen?.name ?? map.robot })}
        data-drawing={drawing}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- it is moved, zoomed and pointed at by keys
        tabIndex={0}
        {...handlers}
      >
        <MapDrawing map={map} view={view} size={size} rovers={rovers} trails={trails} marked={marked} trials={trials} candidates={candidates} showScan={showScan} zones={zones} wished={wished} drawn={dragged ?? drawn} />
        <span className={css.cross}>
          <Icon name="target" size={28} />
        </span>
      </div>
      <div className={css.tools} role="group" aria-label={t('tools')}>
        <Button icon="plus" iconOnly aria-label={t('larger')} onPress={() => zoomBy(ZOOM_STEP)} />
        <Button icon="minus" iconOnly aria-label={t('smaller')} onPress={() => zoomBy(1 / ZOOM_STEP)} />
        <Button
          icon="fit"
          iconOnly
          aria-label={t('whole')}
          onPress={() => {
            setFollow(false);
            fitAll();
          }}
        />
        {chosen && <Switch icon="target" label={t('follow', { robot: chosen.name })} value={follow} onChange={setFollow} />}
        {canRule && <Draw drawing={drawing} onPress={() => onDraw(drawing ? null : [])} />}
        {senses && <Switch icon="rays" label={t('senses')} value={showScan} onChange={setShowScan} />}
      </div>
    </div>
  );
}

function Draw({ drawing, onPress }: { drawing: boolean; onPress: () => void }) {
  const { t } = useTranslation('map');
  const hasRules = useWorld((world) => world.info?.modules?.rules ?? false);
  if (!hasRules) return null;
  return <Button needs="rule" icon={drawing ? 'close' : 'rules'} iconOnly aria-label={t(drawing ? 'drawEnd' : 'draw')} onPress={onPress} />;
}

interface SwitchProps {
  icon: IconName;
  label: string;
  value: boolean;
  onChange: (value: boolean) => void;
}

function Switch({ icon, label, value, onChange }: SwitchProps) {
  return (
    <ToggleButton className={css.switch ?? ''} aria-label={label} isSelected={value} onChange={onChange}>
      <Icon name={icon} />
    </ToggleButton>
  );
}
