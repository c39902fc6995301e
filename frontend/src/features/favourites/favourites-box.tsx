import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { dropFavourite, putFavourite } from '@/live/api';
import { useWorld } from '@/live/store';
import type { Favourite } from '@/live/types';
import { attempt } from '@/state/do';
import { spelledOut, useKeeping } from '@/state/favourites';
import { useOutbox } from '@/state/outbox';
import { useOverlays } from '@/state/overlays';
import { useSelection } from '@/state/selection';
import { Button } from '@/ui/button';
import { Dialog } from '@/ui/dialog';
import { TextField } from '@/ui/text-field';
import { nameList } from '@/ui/words';

import css from './favourites.module.css';

/** Orders that are kept under a name: to run, to keep one more, to change and to remove. */
export function FavouritesBox() {
  const { t } = useTranslation('favourites');
  const { open, set } = useOverlays();
  const favourites = useWorld((world) => world.favourites);
  const { words, keep } = useKeeping();
  const [changed, setChanged] = useState<Favourite | null>(null);
  const close = () => {
    set('none');
    keep('');
    setChanged(null);
  };
  const done = () => {
    keep('');
    setChanged(null);
  };
  return (
    <Dialog title={t('title')} isOpen={open === 'favourites'} onClose={close}>
      <div className={css.box}>
        {favourites.length === 0 ? <p>{t('empty')}</p> : <p>{t('help')}</p>}
        <ul className={css.list}>
          {favourites.map((one) => (
            <Row key={one.name} favourite={one} onRun={close} onChange={() => setChanged(one)} />
          ))}
        </ul>
        <Form key={changed?.name ?? `new ${words}`} favourite={changed ?? { name: '', words }} onDone={done} />
      </div>
    </Dialog>
  );
}

function Row({ favourite, onRun, onChange }: { favourite: Favourite; onRun: () => void; onChange: () => void }) {
  const { t, i18n } = useTranslation('favourites');
  const chosen = useSelection();
  const send = useOutbox((outbox) => outbox.send);
  const { name, words } = favourite;
  const run = () => {
    void send({ text: spelledOut(name) ?? name, targets: chosen, reply_to: '', images: [] });
    onRun();
  };
  return (
    <li className={css.row}>
      <div>
        <strong>{name}</strong>
        <p className={css.words}>{words}</p>
      </div>
      <Button needs="speak" icon="play" isDisabled={chosen.length === 0} aria-label={t('run', { name, who: nameList(chosen, i18n.language) })} onPress={run}>
        {t('runShort')}
      </Button>
      <Button needs="speak" tone="quiet" icon="edit" iconOnly aria-label={t('change', { name })} onPress={onChange} />
      <Button needs="speak" tone="quiet" icon="trash" iconOnly aria-label={t('drop', { name })} onPress={() => void attempt(() => dropFavourite(name))} />
    </li>
  );
}

/** A new one, or other words and another name for one that is there. */
function Form({ favourite, onDone }: { favourite: Favourite; onDone: () => void }) {
  const { t } = useTranslation(['favourites', 'common']);
  const [name, setName] = useState(favourite.name);
  const [words, setWords] = useState(favourite.words);
  const submit = async () => {
    if (!(await attempt(() => putFavourite(name.trim(), words, favourite.name)))) return;
    setName('');
    setWords('');
    onDone();
  };
  return (
    <form
      className={css.form}
      aria-label={favourite.name ? t('change', { name: favourite.name }) : t('new')}
      onSubmit={(event) => {
        event.preventDefault();
        void submit();
      }}
    >
      <TextField label={t('name')} value={name} onChange={setName} maxLength={60} />
      <TextField label={t('words')} help={t('wordsHelp')} value={words} onChange={setWords} rows={3} maxLength={2000} />
      <div className={css.buttons}>
        {favourite.name && <Button onPress={onDone}>{t('common:cancel')}</Button>}
        <Button needs="speak" type="submit" tone="main" isDisabled={!name.trim() || !words.trim()}>
          {t('keep')}
        </Button>
      </div>
    </form>
  );
}
