import { useEffect, useRef } from 'react';

const TWICE_WITHIN_MS = 700;

/** Escape pressed twice in a row; heard before any open box takes the key to close itself. */
export function useEscapeTwice(run: () => void): void {
  const latest = useRef(run);
  const before = useRef(Number.NEGATIVE_INFINITY);
  useEffect(() => {
    latest.current = run;
  });
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      // Parts of the page pass keys on to others: only what was really pressed counts.
      if (event.repeat || !event.isTrusted) return;
      if (event.key !== 'Escape') {
        before.current = Number.NEGATIVE_INFINITY; // closing one box, then another, is not a stop
        return;
      }
      if (event.timeStamp - before.current < TWICE_WITHIN_MS) {
        before.current = Number.NEGATIVE_INFINITY;
        latest.current();
      } else before.current = event.timeStamp;
    };
    window.addEventListener('keydown', onKey, { capture: true });
    return () => window.removeEventListener('keydown', onKey, { capture: true });
  }, []);
}
