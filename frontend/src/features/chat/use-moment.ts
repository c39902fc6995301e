import { useEffect } from 'react';

import type { ChatEntry } from '@/live/types';
import { useMoment } from '@/state/moment';

interface Options {
  entries: readonly ChatEntry[];
  complete: boolean;
  /** How many of the newest entries are drawn. */
  shown: number;
  draw: (count: number) => void;
  /** Fetches earlier entries. */
  loadOlder: () => Promise<void>;
  scroller: React.RefObject<HTMLDivElement | null>;
  keepPlace: () => void;
}

/** Takes the reader to a moment of the conversation that another page asked for. */
export function useMomentShown({ entries, complete, shown, draw, loadOlder, scroller, keepPlace }: Options): void {
  const { unixMs, seen } = useMoment();
  useEffect(() => {
    if (unixMs === 0 || entries.length === 0) return;
    const oldest = entries[0];
    if (oldest && oldest.unix_ms > unixMs && !complete) {
      void loadOlder();
      return;
    }
    const found = entries.findIndex((entry) => entry.unix_ms >= unixMs);
    const at = found < 0 ? entries.length - 1 : found;
    if (entries.length - at > shown) {
      draw(entries.length - at);
      return;
    }
    const element = scroller.current?.querySelector<HTMLElement>(`[data-entry="${CSS.escape(entries[at]?.id ?? '')}"]`);
    if (!element) return;
    seen();
    keepPlace();
    element.scrollIntoView({ block: 'center' });
    element.focus({ preventScroll: true });
  }, [unixMs, entries, complete, shown, draw, loadOlder, scroller, keepPlace, seen]);
}
