import { useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getChat } from '@/live/api';
import { useLive, useWorld } from '@/live/store';
import type { ChatEntry } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { dayName } from '@/ui/words';

import { Entry } from './entry';
import css from './history.module.css';
import { undelivered, useOutbox } from '@/state/outbox';
import { PendingEntry } from './pending-entry';
import { askedAnew, offering, wishing } from '@/live/questions';
import { speakerKey } from './speaker';
import { Thinking } from './thinking';
import { useMomentShown } from './use-moment';
import { useStickToEnd } from './use-stick-to-end';

interface Props {
  entries: readonly ChatEntry[];
  /** Those that are answered beside where one writes, not here. */
  asked: readonly ChatEntry[];
  onChoose: (entry: ChatEntry, choice: string) => void;
  onEdit: (text: string) => void;
  /** Shown instead, while nothing was said. */
  empty: React.ReactNode;
}

const PAGE = 60;

const sameSpeaker = (a: ChatEntry | undefined, b: ChatEntry) => a !== undefined && speakerKey(a) === speakerKey(b);

const sameDay = (a: number, b: number) => new Date(a).toDateString() === new Date(b).toDateString();

/** The conversation, newest at the end; only its newest part is drawn until more is asked for. */
export function History({ entries, asked, onChoose, onEdit, empty }: Props) {
  const { t } = useTranslation('chat');
  const complete = useWorld((world) => world.chatComplete);
  const everything = useWorld((world) => world.chat);
  const messages = useOutbox((outbox) => outbox.messages);
  const waiting = useMemo(
    () => undelivered(messages, new Set(everything.map((entry) => entry.id))),
    [messages, everything],
  );
  const [shown, setShown] = useState(PAGE);
  const { scroller, atEnd, unseen, toEnd, keepPlace } = useStickToEnd(entries, waiting.length, shown);
  const offers = useMemo(() => offering(entries.filter((one) => !asked.includes(one))), [entries, asked]);
  const anew = useMemo(() => askedAnew(entries), [entries]);
  const proposals = useWorld((world) => world.proposals);
  const wishes = useMemo(() => wishing(entries, Object.values(proposals)), [entries, proposals]);
  const visible = entries.slice(-shown);
  const more = shown < entries.length || !complete;

  // Of all that can be pressed in here only one entry's is on the way of Tab; arrow keys lead to the others.
  const [entered, setEntered] = useState('');
  const stop = visible.some((entry) => entry.id === entered) ? entered : visible.at(-1)?.id;
  const onFocus = ({ target }: React.FocusEvent) => setEntered(target.closest<HTMLElement>('[data-entry]')?.dataset.entry ?? '');

  useMomentShown({ entries, complete, shown, draw: setShown, loadOlder, scroller, keepPlace });

  const showOlder = async () => {
    keepPlace();
    if (shown + PAGE > entries.length && !complete) await loadOlder();
    setShown(shown + PAGE);
  };

  if (entries.length === 0 && waiting.length === 0 && complete) return <div className={css.scroller}>{empty}</div>;
  return (
    <div className={css.frame}>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys */}
      <div className={css.scroller} ref={scroller} tabIndex={0} role="region" aria-label={t('history')}>
        <div className={css.top}>
          {more ? (
            <Button onPress={() => void showOlder()}>{t('older')}</Button>
          ) : (
            <p className={css.beginning}>{t('beginning')}</p>
          )}
        </div>
        {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- keys move between what was said */}
        <ol className={css.list} aria-live="polite" aria-relevant="additions" onFocus={onFocus} onKeyDown={onArrow}>
          {visible.map((entry, index) => {
            const before = visible[index - 1];
            const newDay = !before || !sameDay(before.unix_ms, entry.unix_ms);
            return [
              newDay && <Day key={`day-${entry.id}`} unixMs={entry.unix_ms} />,
              <Entry
                key={entry.id}
                entry={entry}
                offers={offers.has(entry.id)}
                asks={asked.includes(entry) || wishes.has(entry.id)}
                isAnew={anew.has(entry.id)}
                isStop={entry.id === stop}
                showName={newDay || !sameSpeaker(before, entry)}
                onChoose={onChoose}
                onEdit={onEdit}
              />,
            ];
          })}
          {waiting.map((message) => (
            <PendingEntry key={message.id} message={message} />
          ))}
        </ol>
        <Thinking last={waiting.length > 0 ? undefined : entries.at(-1)} />
      </div>
      {!atEnd && (
        <div className={css.jump}>
          <Button icon="down" onPress={toEnd}>
            {unseen > 0 ? t('newestCount', { count: unseen }) : t('newest')}
          </Button>
        </div>
      )}
    </div>
  );
}

function onArrow(event: React.KeyboardEvent) {
  const here = (event.target as Element).closest('[data-entry]');
  const all = [...event.currentTarget.querySelectorAll<HTMLElement>('[data-entry]')];
  const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!here || !by) return;
  event.preventDefault();
  all[all.findIndex((one) => one === here) + by]?.focus();
}

async function loadOlder(): Promise<void> {
  const live = useLive.getState();
  await attempt(async () => {
    const page = await getChat({ before: live.world.chatFrom, limit: 200 });
    live.takeOlderChat(page.entries, page.complete);
  });
}

function Day({ unixMs }: { unixMs: number }) {
  const { t, i18n } = useTranslation('chat');
  const [now] = useState(() => Date.now());
  const yesterday = now - 86_400_000;
  let words = dayName(unixMs, now, i18n.language);
  if (sameDay(unixMs, now)) words = t('today');
  else if (sameDay(unixMs, yesterday)) words = t('yesterday');
  return <li className={css.day}>{words}</li>;
}
