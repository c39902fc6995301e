/** What this person chose for this browser; kept in its storage. */
import { create } from 'zustand';
import { createJSONStorage, persist } from 'zustand/middleware';

import { languages } from '@/i18n';

export type Theme = 'system' | 'light' | 'dark' | 'contrast';
/** The name of a folder of `i18n`. */
export type Language = string;
/** `standard`: queued grey, working yellow, done green, stopped red, failed blue; `traffic`: failed red, working blue. */
export type PlanColours = 'standard' | 'traffic';

interface Prefs {
  theme: Theme;
  language: Language;
  planColours: PlanColours;
  /** Whether messages show their time and kind. */
  debug: boolean;
  /** Whether the first steps were seen. */
  welcomed: boolean;
  /** Whether it was read that nobody has to sign in here. */
  openNoted: boolean;
  /** Whether the offer of a model was put away. */
  modelNoted: boolean;
  /** Whether robots that wait are heard: by sound, buzzing and the system's notes. */
  loud: boolean;
  set: (change: Partial<Omit<Prefs, 'set'>>) => void;
}

function browserLanguage(): Language {
  const [wanted = 'en'] = navigator.language.split('-');
  return wanted in languages ? wanted : 'en';
}

export const usePrefs = create<Prefs>()(
  persist(
    (set) => ({
      theme: 'system',
      language: browserLanguage(),
      planColours: 'standard',
      debug: false,
      welcomed: false,
      openNoted: false,
      modelNoted: false,
      loud: false,
      set,
    }),
    { name: 'parley.prefs', version: 1, storage: createJSONStorage(() => localStorage) },
  ),
);

/** Put the look on the page's root, where the style sheets expect it. */
export function applyLook({ theme, planColours, language }: Pick<Prefs, 'theme' | 'planColours' | 'language'>): void {
  const root = document.documentElement;
  if (theme === 'system') delete root.dataset.theme;
  else root.dataset.theme = theme;
  root.dataset.planColours = planColours;
  root.lang = language;
}
