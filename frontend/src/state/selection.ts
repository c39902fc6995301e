/** Which robots the person is talking to; it outlives that the page is loaded again, and goes with its tab. */
import { create } from 'zustand';
import { createJSONStorage, persist } from 'zustand/middleware';

import { useWorld } from '@/live/store';

interface Selection {
  chosen: readonly string[];
  /** Only this one. */
  only: (name: string) => void;
  /** In or out; the last one stays. */
  toggle: (name: string, names: readonly string[]) => void;
  all: (names: readonly string[]) => void;
}

export const useSelectionStore = create<Selection>()(
  persist(
    (set) => ({
      chosen: [],
      only: (name) => set({ chosen: [name] }),
      toggle: (name, names) => set((now) => ({ chosen: toggled(effective(now.chosen, names), name) })),
      all: (names) => set({ chosen: names }),
    }),
    {
      name: 'parley.chosen',
      version: 1,
      storage: createJSONStorage(() => sessionStorage),
      partialize: ({ chosen }) => ({ chosen }),
    },
  ),
);

/** The chosen robots that exist; the first one when none of them does. */
export function effective(chosen: readonly string[], names: readonly string[]): readonly string[] {
  const there = names.filter((name) => chosen.includes(name));
  return there.length > 0 ? there : names.slice(0, 1);
}

function toggled(chosen: readonly string[], name: string): readonly string[] {
  if (!chosen.includes(name)) return [...chosen, name];
  return chosen.length > 1 ? chosen.filter((other) => other !== name) : chosen;
}

/** Names of all robots, in alphabetical order. */
export function useRobotNames(): readonly string[] {
  const robots = useWorld((world) => world.robots);
  return Object.keys(robots).sort((a, b) => a.localeCompare(b));
}

/** The robots spoken to, in alphabetical order. */
export function useSelection(): readonly string[] {
  const chosen = useSelectionStore((state) => state.chosen);
  return effective(chosen, useRobotNames());
}
