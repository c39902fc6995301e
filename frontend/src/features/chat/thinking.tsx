import { useEffect, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { onServerClock } from '@/live/server-time';
import type { ChatEntry } from '@/live/types';
import { nameList } from '@/ui/words';

import css from './thinking.module.css';

const SLOW_MS = 500;
/** By then whoever thinks has said that it takes long, or never will. */
const GIVEN_UP_MS = 30_000;

/** That what was said last is being understood, where that takes a while. */
export function Thinking({ last }: { last: ChatEntry | undefined }) {
  const { t, i18n } = useTranslation('chat');
  const asked = last?.who === 'operator' && last.type !== 'response' ? last : null;
  const isSlow = useBetween(asked?.id ?? '', asked?.unix_ms ?? 0);
  return (
    <p className={css.thinking} role="status">
      {asked && isSlow && (
        <>
          <span className={css.dots} aria-hidden="true">
            <i />
            <i />
            <i />
          </span>
          {t('thinking', { count: asked.targets.length, robots: nameList(asked.targets, i18n.language) })}
        </>
      )}
    </p>
  );
}

/** Whether it was said long enough ago, and not too long. */
function useBetween(id: string, unixMs: number): boolean {
  const [slow, setSlow] = useState('');
  useEffect(() => {
    const left = GIVEN_UP_MS - (onServerClock(Date.now()) - unixMs);
    if (!id || left <= 0) return undefined;
    const timers = [setTimeout(() => setSlow(id), SLOW_MS), setTimeout(() => setSlow(''), Math.min(left, GIVEN_UP_MS))];
    return () => timers.forEach(clearTimeout);
  }, [id, unixMs]);
  return slow === id && id !== '';
}
