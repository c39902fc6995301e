import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import type { MapInfo } from '@/live/types';
import { useMay } from '@/state/me';
import { Button } from '@/ui/button';

import css from './map.module.css';
import { nameOf } from './marks';
import { useEdits } from './place-edits';

/** What a robot saw and nobody put on the map: whether it belongs there. */
export function FoundOffer({ map }: { map: MapInfo }) {
  const { t, i18n } = useTranslation('map');
  const change = useEdits((edits) => edits.change);
  const may = useMay('map');
  const [later, setLater] = useState<readonly string[]>([]);
  const keyOf = ({ id, x, y }: { id: string; x: number; y: number }) => `${id} ${x} ${y}`;
  const thing = map.objects.find((one) => one.found && !later.includes(keyOf(one)));
  if (!may || !thing) return null;
  const { robot } = map;
  return (
    <div className={css.bar} role="group" aria-label={t('places.seen')}>
      <p>{t('places.saw', { thing: nameOf(thing) })}</p>
      <Button icon="check" onPress={() => void change({ robot, was: thing, put: { ...thing, found: false } }, i18n.language, true)}>
        {t('places.putSeen')}
      </Button>
      <Button onPress={() => void change({ robot, was: thing, put: null }, i18n.language)}>{t('places.notThere')}</Button>
      <Button tone="quiet" icon="close" iconOnly aria-label={t('places.later')} onPress={() => setLater([...later, keyOf(thing)])} />
    </div>
  );
}
