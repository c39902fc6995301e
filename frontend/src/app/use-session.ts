import { useCallback, useEffect, useState } from 'react';

import { ApiError, getSession } from '@/live/api';
import { useLive } from '@/live/store';
import { useMe } from '@/state/me';

interface SessionState {
  state: 'asking' | 'locked' | 'open';
  required: boolean;
  refresh: () => void;
}

const RETRY_MS = 2000;

/** Whether this visitor may use the page; asks until the server answers. */
export function useSession(): SessionState {
  const [session, setSession] = useState<Omit<SessionState, 'refresh'>>({ state: 'asking', required: false });
  const [asked, setAsked] = useState(0);
  useEffect(() => {
    let current = true;
    let timer: ReturnType<typeof setTimeout>;
    getSession().then(
      (info) => {
        const { required, authenticated } = info;
        if (!current) return;
        useMe.getState().take(info);
        setSession({ state: authenticated || !required ? 'open' : 'locked', required });
      },
      (error: unknown) => {
        if (!current) return;
        if (error instanceof ApiError && error.status === 401) setSession({ state: 'locked', required: true });
        else {
          const live = useLive.getState();
          if (live.connection !== 'lost') live.setConnection('lost', Date.now());
          timer = setTimeout(() => setAsked((count) => count + 1), RETRY_MS);
        }
      },
    );
    return () => {
      current = false;
      clearTimeout(timer);
    };
  }, [asked]);
  const refresh = useCallback(() => setAsked((count) => count + 1), []);
  return { ...session, refresh };
}
