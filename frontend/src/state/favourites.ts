/** Orders that are kept under a name: what somebody means who writes one. Plain functions, and which one is being kept. */
import i18next from 'i18next';
import { create } from 'zustand';

import { useLive } from '@/live/store';
import type { Favourite } from '@/live/types';

import { useToasts } from './toasts';

/** Words with which a part is left out, and what stands around the name of that part. */
const LEAVES_OUT = [
  /^(?:please )?(?:skip|without|except(?: for)?|leave out|not|no) (.+)$/i,
  /^leave (.+) out$/i,
  /^(?:mitte|ilma|välja arvatud|jäta vahele) (.+)$/i,
  /^jäta (.+?) (?:vahele|välja)$/i,
];
const LINK = /^[\s,;.:–-]*(?:(?:but|and|aga|kuid|ja)\b)?[\s,]*/i;
const ARTICLE = /^(?:the|a|an) /i;

const sentence = (part: string) => `${part.charAt(0).toUpperCase()}${part.slice(1).replace(/[\s.;,]+$/, '')}.`;
/** Parts as one message. */
const together = (parts: readonly string[]) =>
  parts.length > 1 ? parts.map(sentence).join(' ') : (parts[0] ?? '');
const plain = (words: string) => words.replaceAll(/[\\^$.*+?()[\]{}|]/g, '\\$&');

export type Meant =
  /** What to say. */
  | { words: string }
  /** It names a part that is not there, or is there more than once: the person has to look. */
  | { unclear: string };

/** What is meant by `text` if it begins with the name of a favourite; null if it does not. */
export function meantBy(text: string, favourites: readonly Favourite[]): Meant | null {
  const wanted = text.trim();
  const folded = wanted.toLowerCase();
  const byLength = favourites.toSorted((a, b) => b.name.length - a.name.length);
  const named = byLength.find(({ name }) => folded.startsWith(name.toLowerCase()) && !/^[\p{L}\p{N}]/u.test(wanted.slice(name.length)));
  if (!named) return null;
  const parts = named.words.split('\n').map((part) => part.trim()).filter(Boolean);
  const change = wanted.slice(named.name.length).replace(LINK, '').replace(/[\s.!]+$/, '');
  if (!change) return { words: together(parts) };
  const leaves = LEAVES_OUT.map((pattern) => pattern.exec(change)?.[1]).find(Boolean);
  if (!leaves) return /^then\b/i.test(change) ? { words: together([...parts, change.replace(/^then\s+/i, '')]) } : { unclear: change };
  const about = new RegExp(`(?<![\\p{L}\\p{N}])${plain(leaves.replace(ARTICLE, ''))}(?![\\p{L}\\p{N}])`, 'iu');
  const left = parts.filter((part) => !about.test(part));
  return left.length === parts.length - 1 && left.length > 0 ? { words: together(left) } : { unclear: leaves };
}

interface Keeping {
  /** Words that somebody wants to keep under a name. */
  words: string;
  keep: (words: string) => void;
}

export const useKeeping = create<Keeping>()((set) => ({ words: '', keep: (words) => set({ words }) }));

/** What to send for what somebody wrote; null if it is not plain, and they were told: then nothing is sent. */
export function spelledOut(text: string): string | null {
  const meant = meantBy(text, useLive.getState().world.favourites);
  if (!meant) return text;
  if ('words' in meant) return meant.words;
  useToasts.getState().show({ tone: 'error', message: i18next.t('favourites:unclear', meant), stands: 'deed' });
  return null;
}
