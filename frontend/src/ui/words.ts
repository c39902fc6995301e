/** Small helpers that turn values into words. */

/** Names as a list in the page's language: "A", "A and B", "A, B and C". */
export function nameList(names: readonly string[], language: string): string {
  return new Intl.ListFormat(language, { style: 'long', type: 'conjunction' }).format(names);
}

/** Hours and minutes, with seconds where order matters. */
export function clockTime(unixMs: number, language: string, seconds = false): string {
  return new Intl.DateTimeFormat(language, {
    hour: '2-digit',
    minute: '2-digit',
    ...(seconds ? { second: '2-digit' } : {}),
    hourCycle: 'h23',
  }).format(unixMs);
}

/** A day, without the year if it is this one. */
export function dayName(unixMs: number, nowUnixMs: number, language: string): string {
  const sameYear = new Date(unixMs).getFullYear() === new Date(nowUnixMs).getFullYear();
  return new Intl.DateTimeFormat(language, {
    day: 'numeric',
    month: 'long',
    ...(sameYear ? {} : { year: 'numeric' }),
  }).format(unixMs);
}

/** A name made for programs (`GoToPlace`, `go_to_place`, `a::b`) as words. */
export function inWords(name: string): string {
  const words = name
    .replaceAll('::', ' ')
    .replaceAll(/[_-]+/g, ' ')
    .replaceAll(/(?<=[a-z\d])(?=[A-Z])/g, ' ')
    .trim()
    .toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** With a capital letter in front. */
export const sentence = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Somebody's words as they stand between our quotation marks: their own cannot end them. */
export const quoted = (words: string): string =>
  words
    .replaceAll(/„([^“”„]*)[“”]/g, '‚$1‘')
    .replaceAll(/[“„«‟]/g, '‘')
    .replaceAll(/[”»"]/g, '’')
    .replaceAll(/\s+/g, ' ')
    .trim();

const LONG = /[\p{L}\p{N}]{4,}/gu;

/** Whether somebody's words say more than stands there already; another word for the deed itself is no more. */
export function addsTo(known: string, words: string): boolean {
  const there = new Set(known.toLowerCase().match(LONG));
  const about = words.trimStart().toLowerCase().replace(/^(\S+\s)?\S+:|^\S+/, '');
  return (about.match(LONG) ?? []).some((word) => !there.has(word));
}

/** Day and time. */
export function dayAndTime(unixMs: number, nowUnixMs: number, language: string): string {
  return `${dayName(unixMs, nowUnixMs, language)} ${clockTime(unixMs, language)}`;
}

/** The time of what was today, day and time of everything else. */
export function timeOrDay(unixMs: number, nowUnixMs: number, language: string): string {
  const today = new Date(unixMs).toDateString() === new Date(nowUnixMs).toDateString();
  return today ? clockTime(unixMs, language) : dayAndTime(unixMs, nowUnixMs, language);
}

/** A length of time as a clock shows it: "0:32", "1:05:09". */
export function span(ms: number): string {
  const seconds = Math.max(0, Math.floor(ms / 1000));
  const parts = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60, seconds % 60];
  const shown = parts[0] ? parts : parts.slice(1);
  return shown.map((part, index) => (index ? String(part).padStart(2, '0') : String(part))).join(':');
}

const steps = [
  ['second', 60],
  ['minute', 60],
  ['hour', 24],
] as const;

/** How long ago something was: "12 seconds ago", "3 days ago". */
export function ago(ageMs: number, language: string): string {
  const words = new Intl.RelativeTimeFormat(language, { numeric: 'auto' });
  let count = Math.max(0, Math.round(ageMs / 1000));
  for (const [unit, upTo] of steps) {
    if (count < upTo) return words.format(-count, unit);
    count = Math.floor(count / upTo);
  }
  return words.format(-count, 'day');
}
