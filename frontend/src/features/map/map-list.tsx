import { useTranslation } from 'react-i18next';

import type { MapInfo, MapThing } from '@/live/types';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import type { Rover } from './map-drawing';
import css from './map.module.css';
import { nameOf, type Mark } from './marks';
import { middleOf } from './viewport';

interface Props {
  map: MapInfo;
  rovers: readonly Rover[];
  onMark: (marked: Mark) => void;
}

const nearest = (things: readonly MapThing[], to: { x: number; y: number }) =>
  things.reduce<MapThing | null>(
    (best, thing) =>
      !best || Math.hypot(thing.x - to.x, thing.y - to.y) < Math.hypot(best.x - to.x, best.y - to.y) ? thing : best,
    null,
  );

/** The map in words. */
export function MapList({ map, rovers, onMark }: Props) {
  const { t } = useTranslation('map');
  const things = [...map.objects].sort((a, b) => nameOf(a).localeCompare(nameOf(b)));
  return (
    // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys
    <div className={css.list} role="region" aria-label={t('list')} tabIndex={0}>
      <h3>{t('robots')}</h3>
      <ul>
        {rovers.map((rover) => {
          const thing = nearest(map.objects, rover.pose);
          const way = rover.view && rover.view.path.length > 0 ? t('onTheWay') : '';
          return (
            <li key={rover.name}>
              <p>
                <strong>{rover.title || rover.name}</strong> {thing && t('near', { thing: thing.description || thing.kind })} {way}
              </p>
            </li>
          );
        })}
      </ul>
      {map.rooms.length > 0 && <h3>{t('rooms')}</h3>}
      <ul>
        {map.rooms.map((room) => (
          <li key={room.name}>
            {sentence(room.name)}
            <Button tone="quiet" aria-label={t('pick', { thing: sentence(room.name) })} onPress={() => onMark({ kind: 'room', room, at: middleOf(room) })}>
              {t('pickShort')}
            </Button>
          </li>
        ))}
      </ul>
      <h3>{t('things')}</h3>
      <ul>
        {things.map((thing) => (
          <li key={thing.id}>
            {sentence(nameOf(thing))}
            <Button tone="quiet" aria-label={t('pick', { thing: sentence(nameOf(thing)) })} onPress={() => onMark({ kind: 'thing', thing, at: thing })}>
              {t('pickShort')}
            </Button>
          </li>
        ))}
      </ul>
    </div>
  );
}
