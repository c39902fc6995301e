/** Short notes that appear and go, some of them with a way back. */
import { create } from 'zustand';

import { useLive } from '@/live/store';

type Live = ReturnType<typeof useLive.getState>;

/** Asked at each change: once it is not true any more, the note goes by itself. */
type Stands = (live: Live) => boolean;

interface Words {
  message: string;
  /** Label and deed of its button, e.g. to undo. */
  action?: { label: string; run: () => void };
}

/** A failure stays until it is put away, so it has to say for how long it is true; `deed`: until the person does something else. */
export type Note = Words & ({ tone: 'info'; stands?: Stands } | { tone: 'error'; stands: Stands | 'deed' });

export type Toast = Note & { id: number };

interface Toasts {
  toasts: readonly Toast[];
  nextId: number;
  show: (note: Note) => void;
  dismiss: (id: number) => void;
  /** The person does something: what was told of what they did before is over. */
  anew: () => void;
}

const SHOWN_AT_ONCE = 3;

export const useToasts = create<Toasts>()((set) => ({
  toasts: [],
  nextId: 1,
  show: (note) =>
    set((now) => ({
      toasts: [...now.toasts.filter((other) => other.message !== note.message), { ...note, id: now.nextId }].slice(
        -SHOWN_AT_ONCE,
      ),
      nextId: now.nextId + 1,
    })),
  dismiss: (id) => set((now) => ({ toasts: now.toasts.filter((toast) => toast.id !== id) })),
  anew: () => keep((toast) => toast.stands !== 'deed'),
}));

/** Puts the others away. */
function keep(stays: (toast: Toast) => boolean): void {
  const { toasts } = useToasts.getState();
  const standing = toasts.filter(stays);
  if (standing.length < toasts.length) useToasts.setState({ toasts: standing });
}

useLive.subscribe((live) => keep(({ stands }) => typeof stands !== 'function' || stands(live)));

/** Holds until the connection was lost and is there again. */
export function untilReached(): (live: Live) => boolean {
  let lost = useLive.getState().connection === 'lost'; // perhaps known before this was tried
  return ({ connection }) => {
    lost ||= connection === 'lost';
    return !lost || connection !== 'connected';
  };
}
