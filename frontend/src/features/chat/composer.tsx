import { useEffect } from 'react';
import { FileTrigger } from 'react-aria-components';
import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { useLive, useWorld } from '@/live/store';
import { draftKey, emptyDraft, useDrafts } from '@/state/drafts';
import { spelledOut, useKeeping } from '@/state/favourites';
import { useOverlays } from '@/state/overlays';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';
import { nameList } from '@/ui/words';

import css from './composer.module.css';
import { useOutbox } from '@/state/outbox';
import { readPhoto } from '@/ui/photo';
import type { Answering } from '@/live/questions';
import { useForeign } from '@/state/foreign';
import { useUnattended } from '@/state/unattended';

interface Props {
  chosen: readonly string[];
  answering: Answering;
  /** What was last written to these robots. */
  lastSaid: string;
  input: React.RefObject<HTMLTextAreaElement | null>;
}

/** Where one writes. */
export function Composer({ chosen, answering, lastSaid, input }: Props) {
  const { t, i18n } = useTranslation(['chat', 'common']);
  const key = draftKey(chosen);
  const draft = useDrafts((state) => state.drafts[key] ?? emptyDraft);
  const setDraft = useDrafts((state) => state.set);
  const send = useOutbox((outbox) => outbox.send);
  const unattended = useUnattended((state) => state.choice);
  const nobody = chosen.length === 0;
  const ready = !nobody && (draft.text.trim() !== '' || draft.photo !== null);

  useAsked(input);
  useWantedKeyboard(input);

  const submit = () => {
    if (!ready) return;
    const images = draft.photo ? [draft.photo] : [];
    const text = spelledOut(draft.text.trim());
    if (text === null) return;
    const reply_to = text === draft.text.trim() ? (answering.question?.id ?? '') : '';
    void send({ text, targets: chosen, reply_to, images, unattended: reply_to ? null : unattended });
    setDraft(key, emptyDraft);
    input.current?.focus();
  };

  const onKeyDown = (event: React.KeyboardEvent) => {
    if (event.nativeEvent.isComposing) return;
    if (event.key === 'Enter' && !event.shiftKey) {
      event.preventDefault();
      submit();
    } else if (event.key === 'ArrowUp' && draft.text === '' && lastSaid) {
      event.preventDefault();
      setDraft(key, { text: lastSaid });
    }
  };

  const lost = useLive((live) => live.connection === 'lost' && live.world.run === '');
  const known = useLive((live) => live.world.run !== '');
  const none = lost ? t('common:offline') : t(known ? 'writeNobody' : 'common:loading');
  const label = nobody ? none : t('writeTo', { names: nameList(chosen, i18n.language) });
  const { question } = answering;
  // Where nothing can be tapped, it says that the answer is to be written.
  const hint = question && question.choices.length === 0 ? t('answerTo', { names: nameList(question.targets, i18n.language) }) : label;
  useGrowing(input, draft.text, hint);
  return (
    <form
      className={css.form}
      data-answering={answering.question !== null}
      onSubmit={(event) => {
        event.preventDefault();
        submit();
      }}
    >
      <AwayNote chosen={chosen} />
      <LanguageNote />
      <AnswerNote answering={answering} />
      {draft.photo && (
        <p className={css.photo}>
          {t('attached', { name: draft.photo.name })}
          <Button tone="quiet" icon="close" iconOnly aria-label={t('discard')} onPress={() => setDraft(key, { photo: null })} />
        </p>
      )}
      <div className={css.row}>
        <FavouritesButton text={draft.text} />
        <PhotoButton isDisabled={nobody} onPhoto={(photo) => setDraft(key, { photo })} />
        <textarea
          ref={input}
          data-home
          className={css.input}
          rows={1}
          value={draft.text}
          disabled={nobody}
          aria-label={label}
          title={t('sendHelp')}
          placeholder={nobody ? label : hint}
          maxLength={4000}
          enterKeyHint="send"
          onChange={(event) => setDraft(key, { text: event.target.value })}
          onKeyDown={onKeyDown}
        />
        <Button tone={ready ? 'main' : 'plain'} icon="send" iconOnly aria-label={t('send')} type="submit" isDisabled={!ready} />
      </div>
    </form>
  );
}

/** Who will not hear it now. */
function AwayNote({ chosen }: { chosen: readonly string[] }) {
  const { t, i18n } = useTranslation('chat');
  const robots = useWorld((world) => world.robots);
  const away = chosen.filter((name) => robots[name] && robots[name].connection !== 'here');
  if (away.length === 0) return null;
  return <p className={css.away}>{t('notHere', { name: nameList(away, i18n.language), count: away.length })}</p>;
}

/** That orders are understood in another language than the page's, before somebody finds out. */
function LanguageNote() {
  const { t } = useTranslation('chat');
  if (!useForeign()) return null;
  return (
    <p className={css.language}>
      {t('speaksEnglish')} <Link href="/settings">{t('speaksMore')}</Link>
    </p>
  );
}

/** Whom a message answers and for whom it is something new. */
function AnswerNote({ answering }: { answering: Answering }) {
  const { t, i18n } = useTranslation('chat');
  const { question, robots, others } = answering;
  if (!question || others.length === 0) return null;
  return (
    <p className={css.note}>
      {t('split', { answering: nameList(robots, i18n.language), others: nameList(others, i18n.language) })}
    </p>
  );
}

/** To what is kept under a name; what is half written can be kept there. */
function FavouritesButton({ text }: { text: string }) {
  const { t } = useTranslation('favourites');
  const open = useOverlays((state) => state.set);
  const keep = useKeeping((state) => state.keep);
  const show = () => {
    keep(text);
    open('favourites');
  };
  return <Button tone="quiet" icon="star" iconOnly aria-label={t('title')} onPress={show} />;
}

function PhotoButton({ isDisabled, onPhoto }: { isDisabled: boolean; onPhoto: (photo: { name: string; data: string }) => void }) {
  const { t } = useTranslation('chat');
  const show = useToasts((state) => state.show);
  const read = async (file: File | undefined) => {
    if (!file) return;
    useToasts.getState().anew();
    try {
      onPhoto(await readPhoto(file));
    } catch {
      show({ tone: 'error', message: t('attachTooBig'), stands: 'deed' });
    }
  };
  return (
    <FileTrigger acceptedFileTypes={['image/jpeg', 'image/png']} onSelect={(files) => void read(files?.[0])}>
      <Button tone="quiet" icon="photo" iconOnly aria-label={t('attach')} isDisabled={isDisabled} />
    </FileTrigger>
  );
}

/** Takes the keyboard when another part of the page put words here to go on with. */
function useWantedKeyboard(input: React.RefObject<HTMLTextAreaElement | null>) {
  const wanted = useDrafts((state) => state.asked > state.met);
  const meet = useDrafts((state) => state.meet);
  useEffect(() => {
    if (!wanted) return;
    input.current?.focus();
    meet();
  }, [input, wanted, meet]);
}

/** Takes the keyboard when another part of the page put words into the draft. */
function useAsked(input: React.RefObject<HTMLTextAreaElement | null>) {
  const { asked, met, meet } = useDrafts();
  useEffect(() => {
    const box = input.current;
    if (asked === met || !box) return;
    meet();
    box.focus();
    box.setSelectionRange(box.value.length, box.value.length);
  }, [asked, met, meet, input]);
}

const TALLEST_PX = 160;

/** Makes the box as tall as what is written in it, or stands there instead. */
function useGrowing(input: React.RefObject<HTMLTextAreaElement | null>, text: string, label: string) {
  useEffect(() => {
    if (input.current) fitHeight(input.current);
  }, [input, text, label]);
}

function fitHeight(box: HTMLTextAreaElement) {
  box.style.height = 'auto';
  box.style.height = `${Math.min(box.scrollHeight + 2, TALLEST_PX)}px`;
}
