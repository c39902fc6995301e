import { useSyncExternalStore } from 'react';

export type Layout = 'phone' | 'tablet' | 'desktop';

// In letters, not dots: who has the browser write larger gets the layout for less room.
const TABLET = '(min-width: 43.75em)';
const DESKTOP = '(min-width: 73.75em)';
/** Lying phones, and pages that were made twice as large: parts under each other would be slits. */
const LOW = '(max-height: 34.95em) and (max-width: 73.7em)';

function useMedia(query: string): boolean {
  return useSyncExternalStore(
    (changed) => {
      const list = window.matchMedia(query);
      list.addEventListener('change', changed);
      return () => list.removeEventListener('change', changed);
    },
    () => window.matchMedia(query).matches,
  );
}

/** Whether there is so little height that headings have to make room. */
export const useIsLow = () => useMedia(LOW);

/** How much room there is. */
export function useLayout(): Layout {
  const desktop = useMedia(DESKTOP);
  const tablet = useMedia(TABLET);
  const low = useIsLow();
  if (low) return 'phone';
  if (desktop) return 'desktop';
  return tablet ? 'tablet' : 'phone';
}
