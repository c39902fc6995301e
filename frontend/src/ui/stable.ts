/** What stays the same for parts that are costly to draw, however often what is around them is drawn. */
import { useCallback, useLayoutEffect, useRef, useState } from 'react';

/** The same function for as long as the part is there; it does what the newest one would. */
export function useStable<Given extends unknown[], Result>(deed: (...given: Given) => Result): (...given: Given) => Result {
  const newest = useRef(deed);
  useLayoutEffect(() => {
    newest.current = deed;
  });
  return useCallback((...given: Given) => newest.current(...given), []);
}

/** The same value until one comes that says something else. */
export function useSame<T>(value: T): T {
  const [kept, keep] = useState(value);
  if (kept === value || JSON.stringify(kept) === JSON.stringify(value)) return kept;
  keep(value);
  return value;
}
