/** What is half written, per set of chosen robots. */
import { create } from 'zustand';

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
  set: (key: string, change: Partial<Draft>) => void;
}

export const emptyDraft: Draft = { text: '', photo: null };

export const draftKey = (chosen: readonly string[]) => chosen.join('\n');

export const useDrafts = create<Drafts>()((set) => ({
  drafts: {},
  set: (key, change) =>
    set((now) => ({ drafts: { ...now.drafts, [key]: { ...emptyDraft, ...now.drafts[key], ...change } } })),
}));
