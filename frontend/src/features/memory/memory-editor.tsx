import { useState } from 'react';
import { FileTrigger } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { putMemory } from '@/live/api';
import type { MemoryItem } from '@/live/types';
import { attempt } from '@/state/do';
import type { Photo } from '@/state/drafts';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { readPhoto } from '@/ui/photo';
import { TextField } from '@/ui/text-field';
import { inWords } from '@/ui/words';

import css from './memory.module.css';
import { nameFor } from './remembering';

export interface Editing {
  /** Null: a new one. */
  item: MemoryItem | null;
}

interface Props {
  editing: Editing;
  robots: readonly string[];
  onClose: () => void;
}

const ALL = '*';

/** Adds something to remember, or corrects it. */
export function MemoryEditor({ editing: { item }, robots, onClose }: Props) {
  const { t } = useTranslation(['memory', 'common']);
  const [text, setText] = useState(item?.data ?? '');
  const [name, setName] = useState(item?.name ?? '');
  const [scope, setScope] = useState(item?.scope || ALL);
  const [photo, setPhoto] = useState<Photo | null>(null);
  const ready = text.trim() !== '' && nameFor(name || text) !== '';
  const save = async () => {
    const under = item?.name ?? (name.trim() || nameFor(text));
    const common = { info: text.trim(), scope: scope === ALL ? '' : scope };
    const body = photo
      ? ({ type: 'image', data: photo.data, ...common } as const)
      : { data: text.trim(), ...common, info: item?.info ?? '' };
    if (await attempt(() => putMemory(under, body))) onClose();
  };
  const scopes = [{ id: ALL, label: t('forAll') }, ...robots.map((robot) => ({ id: robot, label: t('forOne', { name: robot }) }))];
  return (
    <Dialog title={item ? t('correct', { name: inWords(item.name) }) : t('addTitle')} isOpen onClose={onClose}>
      <form
        className={css.page}
        onSubmit={(event) => {
          event.preventDefault();
          if (ready) void save();
        }}
      >
        <TextField label={t('text')} value={text} onChange={setText} rows={3} autoFocus maxLength={4000} />
        {!item && (
          <>
            <TextField label={t('name')} help={t('nameHelp')} value={name} onChange={setName} maxLength={100} />
            <Choice label={t('for')} value={scope} options={scopes} onChange={setScope} />
            <PhotoChoice photo={photo} onPhoto={setPhoto} />
          </>
        )}
        <DialogButtons>
          <Button onPress={onClose}>{t('common:cancel')}</Button>
          <Button tone="main" type="submit" isDisabled={!ready}>
            {t('common:save')}
          </Button>
        </DialogButtons>
      </form>
    </Dialog>
  );
}

function PhotoChoice({ photo, onPhoto }: { photo: Photo | null; onPhoto: (photo: Photo | null) => void }) {
  const { t } = useTranslation('memory');
  const show = useToasts((state) => state.show);
  const read = async (file: File | undefined) => {
    if (!file) return;
    useToasts.getState().anew();
    try {
      onPhoto(await readPhoto(file));
    } catch {
      show({ tone: 'error', message: t('photoUnusable'), stands: 'deed' });
    }
  };
  if (photo) {
    return (
      <p className={css.photo}>
        <img src={`data:image/jpeg;base64,${photo.data}`} alt={photo.name} />
        <Button tone="quiet" icon="trash" onPress={() => onPhoto(null)}>
          {t('noPhoto')}
        </Button>
      </p>
    );
  }
  return (
    <FileTrigger acceptedFileTypes={['image/jpeg', 'image/png']} onSelect={(files) => void read(files?.[0])}>
      <Button icon="photo">{t('photo')}</Button>
    </FileTrigger>
  );
}
