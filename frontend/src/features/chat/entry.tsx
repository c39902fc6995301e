import { memo } from 'react';
import { useTranslation } from 'react-i18next';

import type { ChatEntry } from '@/live/types';
import { usePrefs } from '@/state/prefs';
import { useMay } from '@/state/me';
import { Icon } from '@/ui/icon';
import { clockTime, inWords, nameList } from '@/ui/words';

import { Choices } from './choices';
import css from './entry.module.css';
import { RuleMap } from './rule-map';
import { useSpeaker } from './speaker';

interface Props {
  entry: ChatEntry;
  /** Whether to say from whom it is: not if the one before was from the same. */
  showName: boolean;
  /** Whether Tab stops at what can be pressed in it. */
  isStop: boolean;
  /** Whether its answers can be tapped. */
  offers: boolean;
  /** Whether the robot waits for an answer to it. */
  asks: boolean;
  /** Whether it asked the same once more later. */
  isAnew?: boolean;
  onChoose: (entry: ChatEntry, choice: string) => void;
  onEdit: (text: string) => void;
}

/** One thing said. */
export const Entry = memo(function Entry({ entry, showName, isStop, offers, asks, isAnew = false, onChoose, onEdit }: Props) {
  const debug = usePrefs((prefs) => prefs.debug);
  const mine = entry.who === 'operator';
  return (
    <li
      className={css.entry}
      tabIndex={-1}
      data-entry={entry.id}
      data-mine={mine}
      data-type={entry.type}
      data-question={questionOf(entry, asks)}
      data-draft={entry.draft || undefined}
      aria-live={entry.draft ? 'off' : undefined}
    >
      {(showName || debug || asks || hasMarks(entry)) && <Head entry={entry} asks={asks} isAnew={isAnew} debug={debug} />}
      <div className={css.said}>
        <Said entry={entry} />
      </div>
      {offers && <Choices entry={entry} onChoose={onChoose} isStop={isStop} />}
      {entry.sources.length > 0 && <Sources names={entry.sources} isStop={isStop} />}
      {mine && entry.message && <Again text={entry.message} isStop={isStop} onEdit={onEdit} />}
    </li>
  );
});

/** How far a question is; what is asked in a reply is one as well. */
const questionOf = (entry: ChatEntry, asks: boolean) => (asks ? 'open' : entry.question || undefined);

/** Whether something stands in its head besides from whom it is. */
const hasMarks = (entry: ChatEntry) => entry.question !== '' || entry.engine !== '';

/** Takes own words up again, to change and send them. */
function Again({ text, isStop, onEdit }: Pick<Props, 'isStop' | 'onEdit'> & { text: string }) {
  const { t } = useTranslation('chat');
  const maySpeak = useMay('speak');
  if (!maySpeak) return null;
  return (
    <button type="button" className={css.edit} tabIndex={isStop ? 0 : -1} aria-label={t('edit')} title={t('edit')} onClick={() => onEdit(text)}>
      <Icon name="edit" size={16} />
    </button>
  );
}

/** Words and pictures; either may be missing. */
function Said({ entry }: { entry: ChatEntry }) {
  const { t, i18n } = useTranslation('chat');
  const name = nameList(entry.targets, i18n.language);
  return (
    <>
        {entry.message && <p className={css.text}>{entry.message}</p>}
        {entry.images.map((address) => (
          <img key={address} className={css.image} src={address} alt={entry.who === 'robot' ? t('seen', { name }) : t('photo')} loading="lazy" />
        ))}
        {entry.question === 'open' && entry.rules.length > 0 && <RuleMap robot={entry.targets[0] ?? ''} rules={entry.rules} />}
        {entry.draft && <span className={css.drafting}>{t('drafting')}</span>}
    </>
  );
}

function Head({ entry, asks, isAnew, debug }: { entry: ChatEntry; asks: boolean; isAnew: boolean; debug: boolean }) {
  const { t, i18n } = useTranslation('chat');
  const speaker = useSpeaker();
  const names = nameList(entry.targets, i18n.language);
  return (
    <p className={css.head}>
      {entry.who === 'operator' ? (
        <>
          <strong>{speaker(entry)}</strong>
          <span>{t('to', { names: names || t('everyone') })}</span>
        </>
      ) : (
        <>
          <strong>{names || t('everyone')}</strong>
          {asks && <span className={css.badge}>{t('asks')}</span>}
          {entry.question === 'answered' && <span>{t(isAnew ? 'askedAnew' : afterwards(entry))}</span>}
          {(entry.question === 'closed' || entry.question === 'interrupted') && <span>{t(entry.question)}</span>}
          {entry.engine && <span data-engine>{entry.engine}</span>}
        </>
      )}
      {debug && (
        <>
          <span className={css.kind} data-kind={entry.type}>
            {t(`kind.${entry.type}`)}
          </span>
          <time dateTime={new Date(entry.unix_ms).toISOString()}>{clockTime(entry.unix_ms, i18n.language, true)}</time>
        </>
      )}
    </p>
  );
}

/** Whatever is said next settles what a reply asks: only of what a robot waits for it is known that it was answered. */
const afterwards = ({ type }: ChatEntry) => (type === 'request' ? 'answered' : 'asked');

function Sources({ names, isStop }: { names: readonly string[]; isStop: boolean }) {
  const { t } = useTranslation('chat');
  return (
    <p className={css.sources}>
      <span>{t('because')}</span>
      {names.map((name) => (
        <a key={name} tabIndex={isStop ? 0 : -1} href={`#/memory?name=${encodeURIComponent(name)}`}>
          {inWords(name)}
        </a>
      ))}
    </p>
  );
}
