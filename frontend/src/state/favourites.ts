/** Orders that are kept under a name: what somebody means who writes one. Plain functions, and which one is being kept. */
import i18next from 'i18next';
import { create } from 'zustand';

import { useLive } from '@/live/store';
import type { Favourite } from '@/live/types';

import { useToasts } from './toasts';

/** Words with which a part is left out, and what stands around the name of that part; of several lines, English and Estonian. */
const LEAVES_OUT = [
  [/^(?:please )?(?:skip|without|except(?: for)?|leave out|not|no) (.+)$/i, false],
  [/^leave (.+) out$/i, false],
  [/^(?:mitte|ilma|välja arvatud|jäta vahele) (.+)$/i, true],
  [/^jäta (.+?) (?:vahele|välja)$/i, true],
] as const;
const THEN = /^(?:then|siis|seejärel) /i;
const LINK = /^[\s,;.:–-]*(?:(?:but|and|aga|kuid|ja)\b)?[\s,]*/i;
const ARTICLE = /^(?:the|a|an) /i;

/** With one of these a clause of its own begins. */
const VERBS =
  'go|drive|move|come|return|check|look|inspect|verify|see|find|search|bring|take|get|fetch|put|pick|wait|follow|guide|turn|open|close|switch|count|ask|dock' +
  '|mine|sõida|liigu|tule|naase|kontrolli|vaata|uuri|leia|otsi|too|vii|võta|pane|oota|järgne|juhata|pööra|ava|sulge|lülita|loe|küsi';
const CLAUSE = new RegExp(`(?<=[.;!?])\\s+|(?<=\\s\\S+)(?:\\s*[,;]\\s*|\\s+)(?:(?:and|ja|ning)\\s+)?(?:(?:then|siis|seejärel)\\s+)?(?<=[\\s,;])(?=(?:${VERBS})\\s)`, 'i');
const BETWEEN = /(\s*,\s*(?:and\s+)?|\s+(?:and|ja|ning)\s+)/i;
const BACK = /\b(?:it|its|them|there|him|her|one|that|see|seda|selle|sellega|need|neid|nende|seal|sinna|sealt|tema|teda|talle)\b/i; // what is meant by it was said before
const TURNS = /(?<!\p{L})(?:except|but|without|not|unless|if|or|between|välja arvatud|aga|kuid|ilma|mitte|kui|või|vahel)(?!\p{L})/iu; // with less in it, it might mean more
const SET = /(?<!\p{L})(?:all|every|each|everything|everywhere|kõik|kõiki|iga|igat|igal pool)(?!\p{L})/iu;
const END = /[\s.;,]+$/;

const sentence = (part: string) => `${part.charAt(0).toUpperCase()}${part.slice(1).replace(END, '')}`.replace(/(?<![?!])$/, '.');
/** Parts as one message. */
const together = (parts: readonly string[]) =>
  parts.length > 1 ? parts.map(sentence).join(' ') : (parts[0] ?? '');
const plain = (words: string) => words.replaceAll(/[\\^$.*+?()[\]{}|]/g, '\\$&');
const folded = (words: string) => words.replace(ARTICLE, '').toLowerCase();
const ends = (words: string) => [/^\S+/, /\S+$/].map((end) => end.exec(folded(words))?.[0] ?? '');

/** The name of what is left out, as it may be written in an order, and how all but it is said. */
interface Named {
  name: string;
  ends: readonly RegExp[];
  pattern: string;
  except: string;
}

/** @param cased Whether words have other ends in other cases: then their beginnings count, and no more than one thing may begin so. */
function named(name: string, cased: boolean): Named {
  const word = (one: string) => (cased && /^\p{L}{3,}$/u.test(one) ? `${one.slice(0, Math.max(3, one.length - 2))}\\p{L}{0,3}` : plain(one));
  const whole = (pattern: string) => new RegExp(`^${pattern}$`, 'iu');
  const pattern = name.split(/\s+/).map(word).join('\\s+');
  return { name, ends: ends(name).map((one) => whole(word(one))), pattern, except: cased ? 'välja arvatud' : 'except' };
}


/** Without one thing, of the parts or of a list in one of them; null where it is not plain what is left then. */
function without(parts: readonly string[], name: Named): readonly string[] | null {
  const about = new RegExp(`(?<![\\p{L}\\p{N}])${name.pattern}(?![\\p{L}\\p{N}])`, 'iu');
  const [hit, ...more] = parts.filter((part) => about.test(part));
  if (hit === undefined) return exceptFor(parts, name);
  if (more.length > 0) return null;
  const pieces = hit.replace(END, '').split(BETWEEN);
  if (TURNS.test(hit) || pieces.filter((item) => about.test(item)).length > 1) return null;
  const isAlike = (item: string) => ARTICLE.test(item) || ends(item).some((word, at) => name.ends[at]?.test(word));
  if (!pieces.some((item, at) => at > 0 && at % 2 === 0 && isAlike(item))) {
    const needs = BACK.test(parts[parts.indexOf(hit) + 1] ?? '');
    return needs || parts.length === 1 ? null : parts.filter((part) => part !== hit);
  }
  const shorter = fromList(pieces, name, about, isAlike);
  return shorter === null ? null : parts.map((part) => (part === hit ? shorter : part));
}

/** The one part that is about all of something, but for one thing: the robot knows what all are. */
function exceptFor(parts: readonly string[], { name, except }: Named): readonly string[] | null {
  const [set, ...others] = parts.filter((part) => SET.test(part));
  if (set === undefined || others.length > 0 || TURNS.test(set)) return null;
  return parts.map((part) => (part === set ? `${part.replace(END, '')}, ${except} ${name}` : part));
}

/** A list in words without one of its items: what stands before the first one stays, what stands behind one is not guessed. */
function fromList(pieces: readonly string[], { pattern }: Named, about: RegExp, isAlike: (item: string) => boolean): string | null {
  const at = pieces.findIndex((item, index) => index % 2 === 0 && about.test(item));
  const item = pieces[at] ?? '';
  if (at > 0) {
    if (!new RegExp(`^${pattern}$`, 'iu').test(folded(item))) return null;
    const endsIt = at === pieces.length - 1 && at > 2; // then the one before becomes the last one
    const left = endsIt ? [...pieces.slice(0, at - 3), pieces[at - 1], pieces[at - 2]] : [...pieces.slice(0, at - 1), ...pieces.slice(at + 1)];
    return left.join('');
  }
  const next = pieces[2] ?? '';
  const head = new RegExp(`^(.*?)(?:(?<!\\p{L})(?:the|a|an)\\s+)?${pattern}$`, 'iu').exec(item)?.[1];
  return head && isAlike(next) ? [head, next, ...pieces.slice(3)].join('') : null;
}

export type Meant =
  /** What to say. */
  | { words: string }
  /** It names a part that is not there, or is there more than once: the person has to look. */
  | { unclear: string };

/** What is meant by `text` if it begins with the name of a favourite; null if it does not. */
export function meantBy(text: string, favourites: readonly Favourite[]): Meant | null {
  const wanted = text.trim();
  const said = wanted.toLowerCase();
  const byLength = favourites.toSorted((a, b) => b.name.length - a.name.length);
  const favourite = byLength.find(({ name }) => said.startsWith(name.toLowerCase()) && !/^[\p{L}\p{N}]/u.test(wanted.slice(name.length)));
  if (!favourite) return null;
  const trimmed = (some: readonly string[]) => some.map((part) => part.trim()).filter(Boolean);
  const parts = trimmed(favourite.words.split('\n'));
  const change = wanted.slice(favourite.name.length).replace(LINK, '').replace(/[\s.!]+$/, '');
  if (!change) return { words: together(parts) };
  const [pattern, cased] = LEAVES_OUT.find(([one]) => one.test(change)) ?? [null, false];
  const leaves = pattern?.exec(change)?.[1];
  if (!leaves) return THEN.test(change) ? { words: together([...parts, change.replace(THEN, '')]) } : { unclear: change };
  const clauses = BACK.test(favourite.words) ? parts : trimmed(favourite.words.split(CLAUSE));
  const left = without(parts.length > 1 ? parts : clauses, named(leaves.replace(ARTICLE, ''), cased));
  return left && left.length > 0 ? { words: together(left) } : { unclear: leaves };
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
