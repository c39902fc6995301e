/** The story that is played on the page: its sentences are written and sent, whoever looks on answers. */
import { create } from 'zustand';

interface Tour {
  lines: readonly string[];
  /** Which of them is written now. */
  at: number;
  begin: (lines: readonly string[]) => void;
  next: () => void;
  end: () => void;
}

export const useTour = create<Tour>()((set) => ({
  lines: [],
  at: 0,
  begin: (lines) => set({ lines, at: 0 }),
  next: () => set((now) => (now.at + 1 < now.lines.length ? { at: now.at + 1 } : { lines: [], at: 0 })),
  end: () => set({ lines: [], at: 0 }),
}));
