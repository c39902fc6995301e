/** Messages on their way. One leaves as soon as the server tells of it under the same key. */
import { create, type StateCreator } from 'zustand';
import { createJSONStorage, persist } from 'zustand/middleware';

import { ApiError, sendMessage, STOP_TIMEOUT_MS, type OutgoingMessage } from '@/live/api';
import { useLive } from '@/live/store';
import { callsToStop, LATE_MS, pause, RETRY_MS, warnOfLeaving } from './calls-to-stop';
import { explain } from './do';
import { useToasts } from './toasts';

export interface Outgoing extends OutgoingMessage {
  unixMs: number;
  state: 'sending' | 'sent' | 'failed';
  /** Why it failed, for people. */
  reason: string;
  /** Whether it would be refused again as it is, e.g. because its question is settled. */
  refused?: boolean;
  /** Whether it calls to stop: then it is sent until it gets through, as a stop that is pressed. */
  insists?: boolean;
}

/** Whether it did not get through and is sent again by itself. */
export const goesOn = (one: Outgoing | undefined) => one?.state === 'failed' && one.insists === true && !one.refused;

interface Outbox {
  messages: readonly Outgoing[];
  send: (message: Omit<OutgoingMessage, 'id'>) => Promise<void>;
  retry: (id: string) => Promise<void>;
  discard: (id: string) => void;
}

/** With what the keys of all begin that is said in this browser: by it people without accounts know what is their own. */
const OWN = `${localStorage.getItem('parley.browser') ?? crypto.randomUUID().slice(0, 8)}-`;
localStorage.setItem('parley.browser', OWN.slice(0, -1));
export const isOwn = (id: string) => id.startsWith(OWN);

const LONGEST_TURN_MS = 400; // a stop that is typed behind it has one second

/** Sent again without a change it would be refused again: whoever wrote it may not, it cannot be read, or its question is settled. */
const REFUSALS: ReadonlySet<number> = new Set([403, 413, 422]);
const CONFLICT = 409;

/** Said once more within it, it was pressed twice. */
const MOMENT_MS = 500;

/** Whether it is what was just sent, or is still on its way as the answer to the same question. */
const isSame = (one: Outgoing, other: Omit<OutgoingMessage, 'id'>) =>
  one.text === other.text &&
  one.images.length + other.images.length === 0 &&
  one.reply_to === other.reply_to &&
  one.targets.join('\n') === other.targets.join('\n') &&
  (Date.now() - one.unixMs < MOMENT_MS || (other.reply_to !== '' && one.state !== 'failed'));

const outbox: StateCreator<Outbox> = (set, get) => {
  const change = (id: string, part: Partial<Outgoing>) =>
    set((now) => ({ messages: now.messages.map((one) => (one.id === id ? { ...one, ...part } : one)) }));
  const find = (id: string) => get().messages.find((one) => one.id === id);

  const attemptOnce = async ({ id, text, targets, reply_to, images, unattended = null }: OutgoingMessage, withinMs?: number) => {
    try {
      await sendMessage({ id, text, targets, reply_to, images, unattended }, withinMs);
      change(id, { state: 'sent' });
    } catch (error) {
      const status = error instanceof ApiError ? error.status : 0;
      change(id, { state: 'failed', reason: explain(error), refused: REFUSALS.has(status) || (status === CONFLICT && reply_to !== '') });
    }
  };

  const deliver = async (message: OutgoingMessage) => {
    change(message.id, { state: 'sending', reason: '' });
    if (!find(message.id)?.insists) return attemptOnce(message);
    setTimeout(() => find(message.id)?.state === 'sending' && change(message.id, { state: 'failed' }), LATE_MS);
    do {
      await attemptOnce(message, STOP_TIMEOUT_MS);
      if (find(message.id)?.state === 'failed') await pause(RETRY_MS);
    } while (goesOn(find(message.id)));
    return undefined;
  };

  let last: Outgoing | undefined; // also when it is delivered already

  // What is written second must not be heard first, but nor may it wait long for one that is stuck.
  let before: Promise<unknown> = Promise.resolve();
  const inTurn = async (message: OutgoingMessage) => {
    const turn = Promise.race([before, pause(LONGEST_TURN_MS)]).then(() => deliver(message));
    before = turn;
    await turn;
  };

  return {
    messages: [],
    send: async (message) => {
      if (last && isSame(get().messages.find(({ id }) => id === last?.id) ?? last, message)) return;
      const outgoing = { ...message, id: `${OWN}${crypto.randomUUID()}` };
      const begun: Outgoing = { ...outgoing, unixMs: Date.now(), state: 'sending', reason: '', insists: callsToStop(message.text, useLive.getState().world) };
      last = begun;
      useToasts.getState().anew();
      // Who says something else has seen that an answer came too late.
      set((now) => ({ messages: [...now.messages.filter((one) => !(one.refused && one.reply_to)), begun] }));
      await inTurn(outgoing);
    },
    retry: async (id) => {
      const message = find(id);
      if (message) await inTurn(message);
    },
    discard: (id) => {
      if (last?.id === id) last = undefined;
      set((now) => ({ messages: now.messages.filter((one) => one.id !== id) }));
    },
  };
};

/** What was on its way when the page was loaded again may not have arrived: it can be sent again, under the same key; a stop is. */
const unsure = (message: Outgoing): Outgoing => ({ ...message, state: 'failed', reason: message.refused ? message.reason : '' });

export const useOutbox = create<Outbox>()(
  persist(outbox, {
    name: 'parley.outbox',
    version: 1,
    storage: createJSONStorage(() => sessionStorage), // it goes with the tab; photos are too large for it
    partialize: ({ messages }) => ({ messages: messages.filter((one) => one.images.length === 0) }),
    onRehydrateStorage: () => (now) => now?.messages.filter(goesOn).forEach(({ id }) => void now.retry(id)),
    merge: (kept, now) => ({ ...now, messages: ((kept as Partial<Outbox> | undefined)?.messages ?? []).map(unsure) }),
  }),
);

warnOfLeaving(() => useOutbox.getState().messages.some((one) => one.insists && !one.refused && one.state !== 'sent'));

// What the conversation has held once is delivered, also when that part of it is no longer held here.
useLive.subscribe((live, before) => {
  const { messages } = useOutbox.getState();
  if (messages.length === 0 || live.world.chat === before.world.chat) return;
  const left = undelivered(messages, new Set(live.world.chat.map((entry) => entry.id)));
  if (left.length < messages.length) useOutbox.setState({ messages: left });
});

/** Keys of the questions to which an answer is on its way. */
export function answeredIn(messages: readonly Outgoing[]): ReadonlySet<string> {
  return new Set(messages.filter((one) => one.state !== 'failed' && one.reply_to).map((one) => one.reply_to));
}

/** Those that the conversation does not hold yet. A message to several may come back in parts (`key`, `key/2`). */
export function undelivered(messages: readonly Outgoing[], known: ReadonlySet<string>): readonly Outgoing[] {
  return messages.filter((message) => !known.has(message.id));
}
