import { FileTrigger } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { loadPlaces, placesFile } from '@/live/places-api';
import { attempt } from '@/state/do';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';

import { useEdits } from './place-edits';
import own from './places.module.css';

/** The object map as a file: to keep it, and to take one over. */
export function MapFile({ robot }: { robot: string }) {
  const { t } = useTranslation('map');
  const load = async (file: File | undefined) => {
    if (!file) return;
    let whole: unknown;
    try {
      whole = JSON.parse(await file.text());
    } catch {
      useToasts.getState().show({ tone: 'error', message: t('places.noFile'), stands: 'deed' });
      return;
    }
    await attempt(() => loadPlaces(robot, whole));
    useEdits.setState(({ count }) => ({ count: count + 1, done: [] }));
  };
  return (
    <>
      <Button onPress={() => document.getElementById('object-map')?.click()}>{t('places.keep')}</Button>
      <a id="object-map" className={own.hidden} href={placesFile(robot)} download="object_map.json">
        {t('places.keep')}
      </a>
      <FileTrigger acceptedFileTypes={['application/json']} onSelect={(files) => void load(files?.[0])}>
        <Button>{t('places.load')}</Button>
      </FileTrigger>
    </>
  );
}
