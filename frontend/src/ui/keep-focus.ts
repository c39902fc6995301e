/**
 * Keeps the keyboard near where it was when what had it goes away or can no longer be used: in the nearest part that is
 * still there, at its place for writing (`data-home`) or at the part itself, else at the page. It never falls out of that.
 */
const OWN_TURN_MS = 50;

/** Begin to look. @returns How to end it. */
export function keepFocus(): () => void {
  let around: readonly Element[] = [];
  let timer: ReturnType<typeof setTimeout> | undefined;
  const isGone = (element: Element | undefined) => element && (!element.isConnected || element.matches(':disabled'));
  const isNowhere = () => document.activeElement === null || document.activeElement === document.body || isGone(document.activeElement);
  const look = () => {
    if (!isGone(around[0]) || !isNowhere()) return;
    clearTimeout(timer);
    // Boxes that close give the keyboard back themselves; they come first.
    timer = setTimeout(() => isNowhere() && homeOf(around.slice(1))?.focus({ preventScroll: true }), OWN_TURN_MS);
  };
  const onFocus = ({ target }: FocusEvent) => {
    if (target instanceof Element) around = ancestors(target);
  };
  const onPointer = () => {
    around = []; // whoever points elsewhere leaves it
  };
  const watcher = new MutationObserver(look);
  watcher.observe(document.body, { childList: true, subtree: true, attributeFilter: ['disabled'] });
  document.addEventListener('focusin', onFocus);
  document.addEventListener('pointerdown', onPointer, { capture: true });
  return () => {
    clearTimeout(timer);
    watcher.disconnect();
    document.removeEventListener('focusin', onFocus);
    document.removeEventListener('pointerdown', onPointer, { capture: true });
  };
}

function ancestors(element: Element): readonly Element[] {
  return element.parentElement ? [element, ...ancestors(element.parentElement)] : [element];
}

function homeOf(parts: readonly Element[]): HTMLElement | null {
  for (const part of parts.filter((one) => one.isConnected)) {
    const home = part.querySelector<HTMLElement>('[data-home]:not(:disabled)') ?? part.closest<HTMLElement>('[tabindex]');
    if (home) return home;
  }
  return document.querySelector('main'); // of what is another page by now, nothing is left
}
