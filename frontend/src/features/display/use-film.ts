import { useCallback, useEffect, useRef, useState, type RefCallback } from 'react';

import { watchFeed } from '@/live/connection';

import { decode } from './decode';
import { Film } from './film';

interface Shown {
  /** When the newest picture was taken, by the server's clock, in full seconds rounded up; 0 if unknown, null without one. */
  takenUnixMs: number | null;
  /** The canvas on which pictures are to be drawn. */
  screen: RefCallback<HTMLCanvasElement>;
}

const STEP_MS = 1000;

/** Whoever shows an age need not be drawn again for each of ten pictures in a second. */
const inSteps = (unixMs: number): number => Math.ceil(unixMs / STEP_MS) * STEP_MS;

/** The pictures of a feed, for a canvas. */
export function useFilm(robot: string, name: string): Shown {
  const [takenUnixMs, setTaken] = useState<number | null>(null);
  const film = useRef<Film | null>(null);
  const canvas = useRef<HTMLCanvasElement | null>(null);
  useEffect(() => {
    const made = new Film(decode, (meta) => setTaken(inSteps(meta.unix_ms ?? 0)));
    film.current = made;
    made.drawOn(canvas.current);
    const stop = watchFeed({ robot, name }, (bytes, meta) => made.take(bytes, meta));
    return () => {
      stop();
      made.end();
      film.current = null;
      setTaken(null);
    };
  }, [robot, name]);
  const screen = useCallback((element: HTMLCanvasElement | null) => {
    canvas.current = element;
    film.current?.drawOn(element);
  }, []);
  return { takenUnixMs, screen };
}
