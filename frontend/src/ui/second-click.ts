/**
 * Buttons change under the hand: one that was pressed may give its place to another before a double click has ended. The
 * second click of one does nothing where it would meet a button that the first did not. Stopping is never held up.
 */
const SOON_MS = 500;
const NEAR_PX = 12;
const PARTS = ['pointerdown', 'mousedown', 'pointerup', 'mouseup', 'click'] as const;

interface Press {
  ms: number;
  x: number;
  y: number;
  button: Element | null;
  says: string;
}

const buttonAt = (target: EventTarget | null) =>
  target instanceof Element ? target.closest('button, a, [role="button"], [role="option"], [role="menuitem"]') : null;
const saysOf = (button: Element | null) => button?.getAttribute('aria-label') ?? button?.textContent ?? '';

const isSecond = (first: Press, now: Press) => now.ms - first.ms < SOON_MS && Math.hypot(now.x - first.x, now.y - first.y) < NEAR_PX;
const isOther = (first: Press, now: Press) =>
  first.button !== null && now.button !== null && (first.button !== now.button || first.says !== now.says);

/** Begin to look. @returns How to end it. */
export function holdSecondClicks(): () => void {
  let first: Press | null = null;
  let holding = false;
  const onPart = (event: MouseEvent) => {
    if (event.type === 'pointerdown') {
      const button = buttonAt(event.target);
      const now = { ms: event.timeStamp, x: event.clientX, y: event.clientY, button, says: saysOf(button) };
      const again = first !== null && isSecond(first, now);
      holding = again && first !== null && isOther(first, now) && !button?.closest('[data-stops]');
      if (!again) first = now;
    }
    if (!holding) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  const onKey = () => {
    first = null; // a key between two clicks makes them two deeds
  };
  for (const part of PARTS) window.addEventListener(part, onPart, { capture: true });
  window.addEventListener('keydown', onKey, { capture: true });
  return () => {
    window.removeEventListener('keydown', onKey, { capture: true });
    for (const part of PARTS) window.removeEventListener(part, onPart, { capture: true });
  };
}
