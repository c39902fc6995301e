import { useCallback, useEffect, useRef, useState } from 'react';

import type { MapInfo } from '@/live/types';

import { fit, pan, toMap, zoom, type Place, type Size, type Viewport } from './viewport';

const STILL_PX = 6;
const KEY_STEP_PX = 60;
const KEY_ZOOM = 1.3;
const WHEEL = 0.0015;
const MIDDLE_BUTTON = 1;
const BEFORE_MEASURED: Size = { width: 600, height: 400 };

const steps: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [KEY_STEP_PX, 0],
  ArrowRight: [-KEY_STEP_PX, 0],
  ArrowUp: [0, KEY_STEP_PX],
  ArrowDown: [0, -KEY_STEP_PX],
};

interface Options {
  map: MapInfo;
  /** Where to look instead, e.g. at a robot that is followed. */
  followed: Place | null;
  /** The person moved the map by hand. */
  onMoved: () => void;
  /** A place was tapped, or chosen by Enter. */
  onPick: (place: Place) => void;
  /** One finger draws from one place to another rather than moving the map. */
  onDrag: Drag | null;
}

/** `isOver`: the finger is up; null: it was no drawing after all. */
type Drag = (ends: readonly [Place, Place] | null, isOver: boolean) => void;

/** Moves and zooms a map by mouse, touch and keys; or one finger draws on it. */
export function useViewport({ map, followed, onMoved, onPick, onDrag }: Options) {
  const box = useRef<HTMLDivElement>(null);
  const [size, setSize] = useState(BEFORE_MEASURED);
  const [chosen, setChosen] = useState<Viewport | null>(null);
  const whole = fit(map, size);
  const free = chosen ?? whole;
  const view: Viewport = followed ? { scale: free.scale, centre: followed } : free;
  const latest = useRef({ view, size, map, onMoved });
  useEffect(() => {
    latest.current = { view, size, map, onMoved };
  });

  const zoomBy = useCallback((factor: number, at?: Place) => {
    const now = latest.current;
    const middle = { x: now.size.width / 2, y: now.size.height / 2 };
    setChosen(zoom(now.view, now.size, factor, at ?? middle, fit(now.map, now.size).scale / 2));
  }, []);
  const panBy = useCallback((dx: number, dy: number) => {
    const now = latest.current;
    now.onMoved();
    setChosen(pan(now.view, now.map, dx, dy));
  }, []);

  useEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const watcher = new ResizeObserver(() => {
      const { clientWidth, clientHeight } = element;
      if (clientWidth > 0 && clientHeight > 0) setSize({ width: clientWidth, height: clientHeight });
    });
    watcher.observe(element);
    // React listens to wheels passively, which would scroll the page behind.
    const onWheel = (event: WheelEvent) => {
      event.preventDefault();
      zoomBy(Math.exp(-event.deltaY * WHEEL), inside(element, event));
    };
    element.addEventListener('wheel', onWheel, { passive: false });
    return () => {
      watcher.disconnect();
      element.removeEventListener('wheel', onWheel);
    };
  }, [zoomBy]);

  const onKeyDown = (event: React.KeyboardEvent) => {
    const step = steps[event.key];
    if (step) panBy(...step);
    else if (event.key === '+' || event.key === '=') zoomBy(KEY_ZOOM);
    else if (event.key === '-') zoomBy(1 / KEY_ZOOM);
    else if (event.key === '0') setChosen(null);
    else if (event.key === 'Enter') onPick(view.centre);
    else return;
    event.preventDefault();
  };

  const fingers = useFingers({
    panBy,
    zoomBy,
    onTap: (point) => onPick(toMap(view, size, point)),
    onDrag: onDrag && ((ends, isOver) => onDrag(ends && [toMap(view, size, ends[0]), toMap(view, size, ends[1])], isOver)),
  });
  return { box, size, view, zoomBy, fitAll: () => setChosen(null), handlers: { onKeyDown, ...fingers } };
}

interface FingerOptions {
  panBy: (dx: number, dy: number) => void;
  zoomBy: (factor: number, at: Place) => void;
  onTap: (point: Place) => void;
  onDrag: Drag | null;
}

/** One finger moves or draws, two zoom, one that stays where it is taps. */
function useFingers({ panBy, zoomBy, onTap, onDrag }: FingerOptions) {
  const down = useRef(new Map<number, Place>());
  const start = useRef<Place | null>(null);
  const moved = useRef(false);
  const onPointerDown = (event: React.PointerEvent<HTMLDivElement>) => {
    if (event.button === MIDDLE_BUTTON || event.target instanceof HTMLButtonElement) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    moved.current = down.current.size > 0;
    const here = inside(event.currentTarget, event);
    start.current = moved.current ? null : here;
    if (moved.current) onDrag?.(null, false);
    down.current.set(event.pointerId, here);
  };
  const onPointerMove = (event: React.PointerEvent<HTMLDivElement>) => {
    const before = down.current.get(event.pointerId);
    if (!before) return;
    const now = inside(event.currentTarget, event);
    const other = [...down.current].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      zoomBy(distance(now, other) / Math.max(1, distance(before, other)), { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 });
    } else if (moved.current || distance(before, now) > STILL_PX) {
      moved.current = true;
      if (onDrag) onDrag(start.current && [start.current, now], false);
      else panBy(now.x - before.x, now.y - before.y);
    } else return;
    down.current.set(event.pointerId, now);
  };
  const onPointerUp = (event: React.PointerEvent<HTMLDivElement>) => {
    const known = down.current.delete(event.pointerId);
    const now = inside(event.currentTarget, event);
    const isUp = known && event.type === 'pointerup';
    if (moved.current) onDrag?.(isUp && start.current ? [start.current, now] : null, true);
    else if (isUp) onTap(now);
  };
  return { onPointerDown, onPointerMove, onPointerUp, onPointerCancel: onPointerUp };
}

const distance = (a: Place, b: Place) => Math.hypot(a.x - b.x, a.y - b.y);

function inside(element: Element, event: { clientX: number; clientY: number }): Place {
  const box = element.getBoundingClientRect();
  return { x: event.clientX - box.left, y: event.clientY - box.top };
}
