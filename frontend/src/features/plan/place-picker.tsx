import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import type { MapInfo } from '@/live/types';
import { around, type Corner } from '@/ui/corners';
import { Button } from '@/ui/button';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { roomAt, thingAt } from '@/ui/map-places';
import { sentence } from '@/ui/words';
import { ZoneMap } from '@/ui/zone-map';

import css from './plan-editor.module.css';

export interface Places {
  /** What robots can be sent to, by the names that mean just one. */
  names: readonly string[];
  map: MapInfo | null;
  /** The name of what is at a place; empty: nothing that has one. */
  nameAt: (corner: Corner) => { name: string; corners: readonly Corner[] } | null;
}

const REACH_M = 0.25;

export const nothing: Places = { names: [], map: null, nameAt: () => null };

/** The places of a map. */
export function placesOf(map: MapInfo): Places {
  const called = (name: string) => map.objects.filter((one) => one.description === name).length;
  const nameOf = (thing: MapInfo['objects'][number]) => (thing.description && called(thing.description) === 1 ? thing.description : thing.id);
  const names = [...new Set([...map.objects.map(nameOf), ...map.rooms.map((room) => room.name)])];
  return {
    names: names.sort((a, b) => a.localeCompare(b)),
    map,
    nameAt: ([x, y]) => {
      const thing = thingAt(map.objects, { x, y }, REACH_M);
      if (thing) return { name: nameOf(thing), corners: around(thing) };
      const room = roomAt(map.rooms, { x, y });
      return room && { name: room.name, corners: room.corners };
    },
  };
}

/** A place tapped on the map; whoever cannot see it chooses from the list beside it. */
export function PlacePicker({ places, label, onPick }: { places: Places; label: string; onPick: (name: string) => void }) {
  const { t } = useTranslation(['plan', 'common']);
  const [open, setOpen] = useState(false);
  const [found, setFound] = useState<ReturnType<Places['nameAt']>>(null);
  if (!places.map) return null;
  const close = () => {
    setOpen(false);
    setFound(null);
  };
  const take = () => {
    if (found) onPick(found.name);
    close();
  };
  const tap = (corners: readonly Corner[]) => {
    const last = corners.at(-1);
    if (last) setFound(places.nameAt(last));
  };
  return (
    <>
      <Button icon="map" onPress={() => setOpen(true)}>
        {t('onMap')}
      </Button>
      <Dialog title={label} isOpen={open} onClose={close}>
        <ZoneMap map={places.map} rules={[]} draft={found?.corners ?? []} onDraw={tap} />
        <p role="status" className={css.found}>{found ? sentence(found.name) : t('onMapHelp')}</p>
        <DialogButtons>
          <Button onPress={close}>{t('common:cancel')}</Button>
          <Button tone="main" isDisabled={!found} onPress={take}>
            {t('takePlace')}
          </Button>
        </DialogButtons>
      </Dialog>
    </>
  );
}
