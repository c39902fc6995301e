import { useTranslation } from 'react-i18next';

import type { MapThing } from '@/live/types';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import css from './map.module.css';
import { useSaying } from './use-saying';
import type { Place } from './viewport';

interface Props {
  marked: Place | MapThing | null;
  onClear: () => void;
}

/** What can be done with what is picked out. */
export function PlaceBar({ marked, onClear }: Props) {
  const { t } = useTranslation(['map', 'common']);
  const say = useSaying();
  return (
    <div className={css.bar} aria-live="polite">
      {marked ? (
        <>
          <p>
            {'id' in marked
              ? sentence(marked.description || marked.kind)
              : t('place', { x: marked.x.toFixed(1), y: marked.y.toFixed(1) })}
          </p>
          <Button needs="speak" tone="main" icon="chat" onPress={() => say('go', marked)}>
            {t('goThere')}
          </Button>
          <Button needs="speak" onPress={() => say('mention', marked)}>{t('mention')}</Button>
          <Button tone="quiet" icon="close" iconOnly aria-label={t('unmark')} onPress={onClear} />
        </>
      ) : (
        <p className={css.hint}>{t('tap')}</p>
      )}
    </div>
  );
}
