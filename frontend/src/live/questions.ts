/** Which questions are open, and what the next message answers. Plain functions. */
import type { ChatEntry } from './types';

export type Questions = ReadonlyMap<string, ChatEntry>;

/** The newest open question of each robot, without those whose answer is on its way: what is written next answers nothing. */
export function openQuestions(chat: readonly ChatEntry[], answered: ReadonlySet<string>): Questions {
  const open = new Map<string, ChatEntry>();
  for (const entry of chat) {
    if (entry.question !== 'open' || answered.has(entry.id)) continue;
    for (const robot of entry.targets) open.set(robot, entry);
  }
  return open;
}

export interface Answering {
  /** The question that is answered; null: the message is a new request to all. */
  question: ChatEntry | null;
  /** Chosen robots that await an answer. */
  robots: readonly string[];
  /** Chosen robots for which the same message is a new request. */
  others: readonly string[];
}

/** What a message to the chosen robots means. The newest question is the one that is answered. */
export function answering(questions: Questions, chosen: readonly string[]): Answering {
  const robots = chosen.filter((robot) => questions.has(robot));
  const question = robots
    .map((robot) => questions.get(robot))
    .reduce<ChatEntry | null>((newest, one) => (one && (!newest || one.seq > newest.seq) ? one : newest), null);
  return { question, robots, others: chosen.filter((robot) => !questions.has(robot)) };
}

/**
 * What was said to or by any of the chosen robots, or to nobody in particular; each thing once. Where another robot was
 * called in what was said to them, also what that one replied.
 */
export function conversation(chat: readonly ChatEntry[], chosen: readonly string[]): readonly ChatEntry[] {
  const isOwn = ({ targets }: ChatEntry) => targets.length === 0 || targets.some((robot) => chosen.includes(robot));
  const said = new Map(chat.filter((entry) => entry.who === 'operator' && isOwn(entry)).map((entry) => [entry.id, entry.targets]));
  const wasCalled = ({ reply_to, targets }: ChatEntry) => said.has(reply_to) && !targets.some((robot) => said.get(reply_to)?.includes(robot));
  return chat.filter((entry) => isOwn(entry) || wasCalled(entry));
}

/**
 * Keys of the messages whose offered answers can still be tapped: open questions, and replies that nobody
 * has followed up since.
 */
export function offering(chat: readonly ChatEntry[]): ReadonlySet<string> {
  const offers = new Set<string>();
  const spokenTo = new Set<string>();
  const called = new Map<string, readonly string[]>(); // who replied to a message: perhaps others than those it was said to
  for (const entry of chat.toReversed()) {
    if (entry.who === 'operator') {
      for (const robot of [...entry.targets, ...(called.get(entry.id) ?? [])]) spokenTo.add(robot);
      continue;
    }
    called.set(entry.reply_to, [...(called.get(entry.reply_to) ?? []), ...entry.targets]);
    if (entry.choices.length > 0 && stillOffers(entry, spokenTo)) offers.add(entry.id);
  }
  return offers;
}

/** Keys of the questions that were asked once more after the next thing that was said to the robot: that was no answer. */
export function askedAnew(chat: readonly ChatEntry[]): ReadonlySet<string> {
  const anew = new Set<string>();
  const last = new Map<string, { entry: ChatEntry; said: number }>();
  for (const entry of chat) {
    for (const robot of entry.targets) {
      const before = last.get(robot);
      if (entry.who === 'operator') {
        if (before) before.said += 1;
      } else if (entry.question !== '') {
        if (before?.said === 1 && before.entry.message === entry.message) anew.add(before.entry.id);
        last.set(robot, { entry, said: 0 });
      }
    }
  }
  return anew;
}

/** What a person has to answer before a robot goes on, oldest first: questions, and offers of a robot that waits for help. */
export function askedOf(chat: readonly ChatEntry[], helpless: ReadonlySet<string>): readonly ChatEntry[] {
  const offers = offering(chat);
  const waits = (entry: ChatEntry) => entry.type !== 'info' || entry.targets.some((robot) => helpless.has(robot));
  return chat.filter((entry) => entry.question === 'open' || (offers.has(entry.id) && waits(entry)));
}

/** Keys of the messages in which a robot asks for a yes to what waits for one: its newest, as many as wait. */
export function wishing(chat: readonly ChatEntry[], proposals: readonly { robot: string }[]): ReadonlySet<string> {
  const keys = new Set<string>();
  const left = proposals.map(({ robot }) => robot);
  for (const entry of chat.toReversed()) {
    const at = entry.asks_yes ? left.findIndex((robot) => entry.targets.includes(robot)) : -1;
    if (at < 0) continue;
    keys.add(entry.id);
    left.splice(at, 1);
  }
  return keys;
}

function stillOffers(entry: ChatEntry, spokenTo: ReadonlySet<string>): boolean {
  if (entry.question === '') return !entry.targets.some((robot) => spokenTo.has(robot));
  return entry.question === 'open';
}
