import { useEffect, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getChat } from '@/live/api';
import type { ChatEntry } from '@/live/types';
import { explain } from '@/state/do';
import { TextField } from '@/ui/text-field';
import { nameList, timeOrDay } from '@/ui/words';

import css from './search-box.module.css';
import { useSpeaker } from './speaker';

const AFTER_TYPING_MS = 250;

type Result = { state: 'idle' } | { state: 'ready'; entries: readonly ChatEntry[] } | { state: 'failed'; reason: string };

/** Finds what was said, however long ago, and leads there. */
export function SearchBox({ onGo, onClose }: { onGo: (entry: ChatEntry) => void; onClose: () => void }) {
  const { t, i18n } = useTranslation('chat');
  const [words, setWords] = useState('');
  const speaker = useSpeaker();
  const [result, setResult] = useState<Result>({ state: 'idle' });
  const [now] = useState(() => Date.now());

  useEffect(() => {
    const asked = words.trim();
    let current = true;
    const timer = setTimeout(() => {
      if (!asked) {
        setResult({ state: 'idle' });
        return;
      }
      getChat({ q: asked, limit: 50 }).then(
        (page) => current && setResult({ state: 'ready', entries: page.entries.toReversed() }),
        (error: unknown) => current && setResult({ state: 'failed', reason: explain(error) }),
      );
    }, AFTER_TYPING_MS);
    return () => {
      current = false;
      clearTimeout(timer);
    };
  }, [words]);

  const onKeyDown = (event: React.KeyboardEvent) => {
    if (event.key === 'Escape') onClose();
  };

  return (
    <div className={css.box} role="search">
      <TextField label={t('search')} hideLabel placeholder={t('searchPlaceholder')} value={words} onChange={setWords} onKeyDown={onKeyDown} autoFocus />
      <div aria-live="polite">
        {result.state === 'failed' && <p>{result.reason}</p>}
        {result.state === 'ready' && result.entries.length === 0 && <p>{t('searchNone')}</p>}
        {result.state === 'ready' && result.entries.length > 0 && (
          <ul className={css.found}>
            {result.entries.map((entry) => (
              <li key={entry.id}>
                <button type="button" className={css.go} onClick={() => onGo(entry)}>
                  <span className={css.when}>
                    {entry.who === 'operator' ? speaker(entry) : nameList(entry.targets, i18n.language)},{' '}
                    {timeOrDay(entry.unix_ms, now, i18n.language)}
                  </span>
                  <span>{entry.message}</span>
                </button>
              </li>
            ))}
          </ul>
        )}
      </div>
    </div>
  );
}
