/** What this page did to rooms and things, with the way back. */
import { create } from 'zustand';

import { changePlace } from '@/live/places-api';
import type { PlaceChanged } from '@/live/types';
import { attempt } from '@/state/do';

import type { Named } from './place-draft';

export interface Edit {
  robot: string;
  was: Named | null;
  put: Named | null;
}

interface Edits {
  /** The last one last. */
  done: readonly Edit[];
  /** Counts what was done, so that the map is asked for anew. */
  count: number;
  /** @returns What came of it; null: it was refused, and the reason was shown. */
  change: (edit: Edit, language: string, anyway?: boolean) => Promise<PlaceChanged | null>;
  undo: (language: string) => Promise<void>;
}

const KEPT = 50;

export const useEdits = create<Edits>()((set, get) => {
  const send = async (edit: Edit, language: string, anyway: boolean): Promise<PlaceChanged | null> => {
    let answer: PlaceChanged | null = null;
    await attempt(async () => {
      answer = await changePlace(edit.robot, { was: edit.was, put: edit.put, anyway, only_try: false, language });
    });
    set(({ count }) => ({ count: count + 1 })); // also after a refusal: somebody else was faster
    return answer;
  };
  return {
    done: [],
    count: 0,
    change: async (edit, language, anyway = false) => {
      const answer = await send(edit, language, anyway);
      if (answer && answer.same.length === 0) {
        const kept: Edit = { ...edit, put: answer.put ?? null };
        set(({ done }) => ({ done: [...done, kept].slice(-KEPT) }));
      }
      return answer;
    },
    undo: async (language) => {
      const last = get().done.at(-1);
      if (!last) return;
      set(({ done }) => ({ done: done.slice(0, -1) })); // what cannot be undone once cannot be later
      await send({ robot: last.robot, was: last.put, put: last.was }, language, true);
    },
  };
});
