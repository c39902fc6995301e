import { useTranslation } from 'react-i18next';

import { changePlace } from '@/live/places-api';
import type { PlaceChanged } from '@/live/types';
import { Button } from '@/ui/button';
import { TextField } from '@/ui/text-field';
import { useKept, useRequest, type Loaded } from '@/ui/use-request';

import css from './map.module.css';
import { isSameKind, isWhole, labelOf, movedHere, putOf, type Draft, type Named } from './place-draft';
import { useEdits } from './place-edits';
import own from './places.module.css';

interface Props {
  robot: string;
  draft: Draft;
  onDraft: (draft: Draft | null) => void;
  onClear: () => void;
}

/** The name of what was drawn, and what people should know before it is on the map. */
export function PlaceForm({ robot, draft, onDraft, onClear }: Props) {
  const { t, i18n } = useTranslation(['map', 'rules']);
  const change = useEdits((edits) => edits.change);
  const count = useEdits((edits) => edits.count);
  const put = putOf(draft);
  const body = { was: draft.was, put, anyway: false, only_try: true, language: i18n.language };
  const key = isWhole(draft) ? `${count}\n${JSON.stringify(body)}` : '';
  const tried = useKept(useRequest(key, () => changePlace(robot, body)));
  const answer = key !== '' && tried.state === 'ready' ? tried.value : null;
  const save = async (was: Named | null, as: Named, anyway: boolean) => {
    const made = await change({ robot, was, put: as }, i18n.language, anyway);
    if (!made || made.same.length > 0) return;
    onDraft(null);
    onClear();
  };
  return (
    <div className={own.form} role="group" aria-label={t(draft.kind === 'room' ? 'places.room' : 'places.thing')}>
      <p className={css.hint} role="status">
        {t(`places.${draft.kind}${draft.corners.length === 0 ? 'First' : 'Next'}`)}
      </p>
      <TextField label={t('places.name')} value={draft.name} onChange={(name) => onDraft({ ...draft, name })} maxLength={80} />
      {key !== '' && <Told tried={tried} />}
      <Button onPress={() => onDraft(null)}>{t('rules:cancel')}</Button>
      <Save answer={answer} draft={draft} put={put} onSave={(...what) => void save(...what)} />
    </div>
  );
}

/** What would come of it. */
function Told({ tried }: { tried: Loaded<PlaceChanged> }) {
  const { t } = useTranslation('map');
  if (tried.state === 'loading') return null;
  if (tried.state === 'failed') return <p className={css.no} role="status">{tried.reason}</p>;
  const { notes, same } = tried.value;
  return (
    <div role="status">
      {notes.map((note) => (
        <p key={note} className={own.note}>
          {note}
        </p>
      ))}
      {same[0] && <p>{t('places.same', { name: labelOf(same[0]) })}</p>}
    </div>
  );
}

interface SaveProps {
  answer: PlaceChanged | null;
  draft: Draft;
  put: Named;
  onSave: (was: Named | null, put: Named, anyway: boolean) => void;
}

/** The way on; with a name that is there already, those that say which is meant. */
function Save({ answer, draft, put, onSave }: SaveProps) {
  const { t } = useTranslation('map');
  const same = answer?.same[0];
  if (!same) {
    return (
      <Button tone="main" icon="check" isDisabled={!answer} onPress={() => onSave(draft.was, put, false)}>
        {t('places.save')}
      </Button>
    );
  }
  return (
    <>
      {draft.was === null && isSameKind(same, put) && <Button onPress={() => onSave(same, movedHere(same, put), true)}>{t('places.move')}</Button>}
      {draft.kind === 'thing' && <Button onPress={() => onSave(draft.was, put, true)}>{t('places.two')}</Button>}
    </>
  );
}
