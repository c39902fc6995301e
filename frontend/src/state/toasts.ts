/** Short notes that appear and go, some of them with a way back. */
import { create } from 'zustand';

export interface Toast {
  id: number;
  tone: 'info' | 'error';
  message: string;
  /** Label and deed of its button, e.g. to undo. */
  action?: { label: string; run: () => void };
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
