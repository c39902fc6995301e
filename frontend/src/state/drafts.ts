/**
 * What is half written, per set of chosen robots; other parts of the page put words in here. The words outlive that the page
 * is loaded again, and go with its tab; photos do not.
 */
import { create } from 'zustand';
import { createJSONStorage, persist } from 'zustand/middleware';

export interface Photo {
  name: string;
  /** Base64 of a JPEG. */
  data: string;
}

export interface Draft {
  text: string;
  photo: Photo | null;
}

interface Drafts {
  drafts: Readonly<Record<string, Draft>>;
  /** Grows when somebody wants to go on writing: who shows the draft takes the keyboard there. */
  asked: number;
  /** The last wish that was met. */
  met: number;
  set: (key: string, change: Partial<Draft>) => void;
  /** Put words behind what is written there already, and go on writing. */
  add: (key: string, words: string) => void;
  meet: () => void;
}

export const emptyDraft: Draft = { text: '', photo: null };

export const draftKey = (chosen: readonly string[]) => chosen.join('\n');

export const useDrafts = create<Drafts>()(
  persist(
    (set) => ({
      drafts: {},
      asked: 0,
      met: 0,
      set: (key, change) =>
        set((now) => ({ drafts: { ...now.drafts, [key]: { ...emptyDraft, ...now.drafts[key], ...change } } })),
      add: (key, words) =>
        set((now) => {
          const before = now.drafts[key] ?? emptyDraft;
          const text = [before.text.trimEnd(), words].filter(Boolean).join(' ');
          return { drafts: { ...now.drafts, [key]: { ...before, text } }, asked: now.asked + 1 };
        }),
      meet: () => set((now) => ({ met: now.asked })),
    }),
    {
      name: 'parley.drafts',
      version: 1,
      storage: createJSONStorage(() => sessionStorage),
      partialize: ({ drafts }) => ({ drafts: wordsOf(drafts) }),
    },
  ),
);

function wordsOf(drafts: Drafts['drafts']): Drafts['drafts'] {
  const written = Object.entries(drafts).filter(([, draft]) => draft.text !== '');
  return Object.fromEntries(written.map(([key, draft]) => [key, { ...draft, photo: null }]));
}
