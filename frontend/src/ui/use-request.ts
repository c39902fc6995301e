import { useEffect, useRef, useState } from 'react';

import { explain } from '@/state/do';

export type Loaded<T> = { state: 'loading' } | { state: 'failed'; reason: string } | { state: 'ready'; value: T };

/** Ask once per key; a late answer to an earlier key is dropped. An empty key asks nothing. */
export function useRequest<T>(key: string, ask: (key: string) => Promise<T>): Loaded<T> {
  const latest = useRef(ask);
  useEffect(() => {
    latest.current = ask;
  });
  const [result, setResult] = useState<{ key: string; loaded: Loaded<T> }>({ key: '', loaded: { state: 'loading' } });
  useEffect(() => {
    let current = true;
    if (key !== '') {
      latest.current(key).then(
        (value) => current && setResult({ key, loaded: { state: 'ready', value } }),
        (error: unknown) => current && setResult({ key, loaded: { state: 'failed', reason: explain(error) } }),
      );
    }
    return () => {
      current = false;
    };
  }, [key]);
  return result.key === key ? result.loaded : { state: 'loading' };
}

/** What was there before stays until what was asked for comes. */
export function useKept<T>(loaded: Loaded<T>): Loaded<T> {
  const [kept, setKept] = useState(loaded);
  if (loaded.state !== 'loading' && kept !== loaded) setKept(loaded);
  return loaded.state === 'loading' ? kept : loaded;
}
