/** A moment of the conversation that somebody wants to see. */
import { create } from 'zustand';

interface Moments {
  /** 0: none. */
  unixMs: number;
  show: (unixMs: number) => void;
  seen: () => void;
}

export const useMoment = create<Moments>()((set) => ({
  unixMs: 0,
  show: (unixMs) => set({ unixMs }),
  seen: () => set({ unixMs: 0 }),
}));
