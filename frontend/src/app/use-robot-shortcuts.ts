import { useEffect } from 'react';

import { useRobotNames, useSelectionStore } from '@/state/selection';

/** Alt+1 … Alt+9: talk to the first, second, … robot; with Shift as well: add or remove it. */
export function useRobotShortcuts(): void {
  const names = useRobotNames();
  const { only, toggle } = useSelectionStore();
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const digit = Number(/^Digit([1-9])$/.exec(event.code)?.[1] ?? 0);
      const name = event.altKey && digit > 0 ? names[digit - 1] : undefined;
      if (!name) return;
      event.preventDefault();
      if (event.shiftKey) toggle(name, names);
      else only(name);
    };
    window.addEventListener('keydown', onKey);
    return () => window.removeEventListener('keydown', onKey);
  }, [names, only, toggle]);
}
