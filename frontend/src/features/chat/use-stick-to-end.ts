import { useEffect, useLayoutEffect, useRef, useState } from 'react';

import type { ChatEntry } from '@/live/types';

const NEAR_PX = 48;

/**
 * Keeps the end in view while the reader is there; counts what comes while they read further up.
 * @param shown How many entries are drawn: when it grows after `keepPlace`, what was in view stays there.
 */
export function useStickToEnd(entries: readonly ChatEntry[], waiting: number, shown: number) {
  const keepFrom = useRef(0);
  const scroller = useRef<HTMLDivElement>(null);
  const stick = useRef(true);
  const stoodAt = useRef(0);
  const [atEnd, setAtEnd] = useState(true);
  const [seen, setSeen] = useState(0);
  const newest = entries.at(-1)?.seq ?? 0;
  const hasContent = entries.length + waiting > 0;

  useEffect(() => {
    const box = scroller.current;
    if (!box) return undefined;
    const size = () => `${box.clientWidth} ${box.clientHeight}`;
    let stoodIn = size();
    const look = () => {
      if (size() !== stoodIn && stick.current) {
        onResize(); // turned, or less of it to be seen: nobody has gone up
        return;
      }
      const isNear = box.scrollHeight - box.scrollTop - box.clientHeight < NEAR_PX;
      // Only who goes up leaves the end: a picture that has just come moves the end away from the reader.
      const end = isNear || (stick.current && box.scrollTop >= stoodAt.current);
      stoodAt.current = box.scrollTop;
      stick.current = end;
      setAtEnd(end);
      if (end) setSeen(Number.MAX_SAFE_INTEGER);
    };
    const onResize = () => {
      stoodIn = size();
      if (!stick.current) return;
      box.scrollTop = box.scrollHeight;
      stoodAt.current = box.scrollTop;
    };
    const watcher = new ResizeObserver(onResize);
    watcher.observe(box);
    if (box.firstElementChild) [...box.children].forEach((child) => watcher.observe(child));
    box.addEventListener('scroll', look, { passive: true });
    return () => {
      watcher.disconnect();
      box.removeEventListener('scroll', look);
    };
  }, [hasContent]);

  const before = useRef(waiting);
  useLayoutEffect(() => {
    if (waiting > before.current) stick.current = true; // what one says oneself one wants to see
    before.current = waiting;
    const box = scroller.current;
    if (!stick.current || !box) return;
    box.scrollTop = box.scrollHeight;
    stoodAt.current = box.scrollTop;
  }, [entries, waiting]);

  useLayoutEffect(() => {
    if (keepFrom.current > 0 && scroller.current) {
      scroller.current.scrollTop += scroller.current.scrollHeight - keepFrom.current;
      keepFrom.current = 0;
    }
  }, [shown]);

  if (!atEnd && seen === Number.MAX_SAFE_INTEGER) setSeen(newest);

  return {
    scroller,
    atEnd,
    unseen: atEnd ? 0 : entries.filter((entry) => entry.seq > seen).length,
    /** Call before earlier entries are put above. */
    keepPlace: () => {
      stick.current = false;
      keepFrom.current = scroller.current?.scrollHeight ?? 0;
    },
    toEnd: () => {
      stick.current = true;
      scroller.current?.scrollTo({ top: scroller.current.scrollHeight });
    },
  };
}
