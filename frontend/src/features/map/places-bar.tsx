import { useTranslation } from 'react-i18next';

import type { MapInfo } from '@/live/types';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import css from './map.module.css';
import type { Mark } from './marks';
import { draftOf, labelOf, newDraft, type Draft, type Named } from './place-draft';
import { useEdits } from './place-edits';
import { MapFile } from './map-file';
import { PlaceForm } from './place-form';

interface Props {
  map: MapInfo;
  marked: Mark | null;
  draft: Draft | null;
  onDraft: (draft: Draft | null) => void;
  onClear: () => void;
}

/** Putting rooms and things on the map: what can be done next. */
export function PlacesBar({ map, marked, draft, onDraft, onClear }: Props) {
  if (draft) return <PlaceForm robot={map.robot} draft={draft} onDraft={onDraft} onClear={onClear} />;
  const chosen = marked && draftOf(marked);
  return chosen?.was ? <Chosen robot={map.robot} was={chosen.was} onChange={() => onDraft(chosen)} onClear={onClear} /> : <Choose map={map} onDraft={onDraft} />;
}

function Choose({ map, onDraft }: { map: MapInfo; onDraft: (draft: Draft) => void }) {
  const { t, i18n } = useTranslation('map');
  const { done, undo } = useEdits();
  const isEmpty = map.rooms.length === 0 && map.objects.length === 0;
  return (
    <div className={css.bar}>
      <p className={css.hint}>{t(isEmpty ? 'places.none' : 'places.hint')}</p>
      <Button tone={isEmpty ? 'main' : 'plain'} icon="square" onPress={() => onDraft(newDraft('room'))}>
        {t('places.room')}
      </Button>
      <Button icon="target" onPress={() => onDraft(newDraft('thing'))}>
        {t('places.thing')}
      </Button>
      <Button icon="undo" isDisabled={done.length === 0} onPress={() => void undo(i18n.language)}>
        {t('places.undo')}
      </Button>
      <MapFile robot={map.robot} />
    </div>
  );
}

function Chosen({ robot, was, onChange, onClear }: { robot: string; was: Named; onChange: () => void; onClear: () => void }) {
  const { t, i18n } = useTranslation('map');
  const change = useEdits((edits) => edits.change);
  const take = async () => {
    if (await change({ robot, was, put: null }, i18n.language)) onClear();
  };
  return (
    <div className={css.bar} aria-live="polite">
      <p>
        <strong>{sentence(labelOf(was))}</strong>
      </p>
      <Button icon="edit" onPress={onChange}>
        {t('places.change')}
      </Button>
      <Button icon="trash" onPress={() => void take()}>
        {t('places.take')}
      </Button>
      <Button tone="quiet" icon="close" iconOnly aria-label={t('unmark')} onPress={onClear} />
    </div>
  );
}
