/** Short notes that appear and go, some of them with a way back. */
import { create } from 'zustand';

import { useLive } from '@/live/store';

type Live = ReturnType<typeof useLive.getState>;

export interface Toast {
  id: number;
  tone: 'info' | 'error';
  message: string;
  /** Label and deed of its button, e.g. to undo. */
  action?: { label: string; run: () => void };
  /** Asked at each change: once it is not true any more, the note goes by itself. */
  stands?: (live: Live) => boolean;
}

interface Toasts {
  toasts: readonly Toast[];
  nextId: number;
  show: (toast: Omit<Toast, 'id'>) => void;
  dismiss: (id: number) => void;
}

const SHOWN_AT_ONCE = 3;

export const useToasts = create<Toasts>()((set) => ({
  toasts: [],
  nextId: 1,
  show: (toast) =>
    set((now) => ({
      toasts: [...now.toasts.filter((other) => other.message !== toast.message), { ...toast, id: now.nextId }].slice(
        -SHOWN_AT_ONCE,
      ),
      nextId: now.nextId + 1,
    })),
  dismiss: (id) => set((now) => ({ toasts: now.toasts.filter((toast) => toast.id !== id) })),
}));

useLive.subscribe((live) => {
  const { toasts } = useToasts.getState();
  const standing = toasts.filter((toast) => toast.stands?.(live) ?? true);
  if (standing.length < toasts.length) useToasts.setState({ toasts: standing });
});

/** Holds until the connection was lost and is there again. */
export function untilReached(): (live: Live) => boolean {
  let lost = false;
  return ({ connection }) => {
    lost ||= connection === 'lost';
    return !lost || connection !== 'connected';
  };
}
