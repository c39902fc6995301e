import { useRef } from 'react';

const LONG_PRESS_MS = 500;

/** Handlers for a long touch; the click that follows one is swallowed. */
export function useLongPress(onLongPress: () => void) {
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const fired = useRef(false);
  const end = () => clearTimeout(timer.current);
  return {
    /** Whether the click that just came ended a long press. */
    wasLong: () => fired.current,
    handlers: {
      onPointerDown: (event: React.PointerEvent) => {
        fired.current = false;
        if (event.pointerType === 'mouse') return;
        timer.current = setTimeout(() => {
          fired.current = true;
          onLongPress();
        }, LONG_PRESS_MS);
      },
      onPointerUp: end,
      onPointerLeave: end,
      onPointerCancel: end,
      onContextMenu: (event: React.MouseEvent) => event.preventDefault(),
    },
  };
}
