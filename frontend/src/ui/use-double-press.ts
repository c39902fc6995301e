import { useEffect } from 'react';

/** Two presses within it at one place are one wish. */
const MOMENT_MS = 500;
const NEAR_PX = 12;
const PRESSABLE = 'button, a, [role="button"], [role="option"], [role="menuitem"]';

interface Press {
  at: number;
  x: number;
  y: number;
  on: Element;
  says: string;
}

const saying = (on: Element) => `${on.getAttribute('aria-label') ?? ''} ${on.textContent}`;

/**
 * Keeps the second half of a double press from reaching what has come under the finger meanwhile, and what stands in
 * `data-once`: a step left out by the first half would be missed by the second. Stopping always gets through.
 */
export function useDoublePress(): void {
  useEffect(() => {
    let last: Press | null = null;
    let isStray = false;
    const look = (event: PointerEvent) => {
      const on = event.target instanceof Element ? event.target.closest(PRESSABLE) : null;
      const [before, x, y, at] = [last, event.clientX, event.clientY, Date.now()];
      const again = before && at - before.at < MOMENT_MS && Math.hypot(x - before.x, y - before.y) < NEAR_PX;
      const isOther = (from: Press, to: Element) => to !== from.on || saying(to) !== from.says || to.closest('[data-once]');
      isStray = Boolean(again && on && !on.closest('[data-stops]') && isOther(before, on));
      if (on && !isStray) last = { at, x, y, on, says: saying(on) };
    };
    const swallow = (event: Event) => {
      if (event.type === 'pointerdown') look(event as PointerEvent);
      else if (event.type === 'click' && (event as PointerEvent).detail === 0) return; // by keys
      if (!isStray) return;
      event.stopImmediatePropagation();
      event.preventDefault();
    };
    const isOver = () => (last = null); // who has pressed a key between two presses means both
    document.addEventListener('keydown', isOver, true);
    for (const kind of PARTS) document.addEventListener(kind, swallow, true);
    return () => {
      document.removeEventListener('keydown', isOver, true);
      PARTS.forEach((kind) => document.removeEventListener(kind, swallow, true));
    };
  }, []);
}

const PARTS = ['pointerdown', 'mousedown', 'pointerup', 'mouseup', 'click'] as const;
