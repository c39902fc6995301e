/**
 * Stopping: pressed here, sent on the line and as a request at once, confirmed by the robots.
 *
 * A stop that does not get through is sent until it does, and said so, unless a person calls it off: whatever killed
 * the server, who pressed finds the robots stopped when it is back.
 */
import { create } from 'zustand';

import { ApiError, sendReset, sendStop, type StopAnswer } from '@/live/api';
import { hearStopLine, stopOnLine } from '@/live/stop-line';
import { useLive } from '@/live/store';
import type { RobotView } from '@/live/types';

import { LATE_MS, pause, RETRY_MS, warnOfLeaving } from './calls-to-stop';

/** What is known of one robot after a stop; `stands` and `moves` are measured. */
export type Fate = StopAnswer['robots'][string];

interface Press {
  id: string;
  targets: readonly string[];
  sinceMs: number;
  /** `late`: not taken yet, though it should be. */
  state: 'sending' | 'late';
}

interface Stopping {
  /** A stop of this page that the server has not taken. */
  pending: Press | null;
  /** What became of the newest one, as it was told with the answer. */
  answer: StopAnswer | null;
  /** @param targets Names of robots; empty: all. */
  stop: (targets: readonly string[]) => Promise<void>;
  /** @throws ApiError The server refused, or was not reached. */
  reset: (targets: readonly string[]) => Promise<void>;
  /** Send a stop that was not taken no longer. */
  callOff: () => void;
}

/** Pressed again within this time, it is the same stop. */
const DOUBLE_MS = 1000;
/** After this time the live stream alone says how the robots fare. */
const TOLD_MS = 12_000;

export const useStopping = create<Stopping>()((set, get) => {
  const waits = (id: string) => get().pending?.id === id;
  /** Does nothing for one that was taken meanwhile. */
  const late = (id: string) => {
    const { pending } = get();
    if (pending?.id === id) set({ pending: { ...pending, state: 'late' } });
  };
  let forget: ReturnType<typeof setTimeout> | undefined;
  const pressed = new Set<string>();
  /** Stops that were released since: what of them is heard later is not so any more. */
  const over = new Set<string>();
  const without = ({ id, robots, ...rest }: StopAnswer): StopAnswer => ({
    ...rest,
    id,
    robots: Object.fromEntries(Object.entries(robots).filter(([name]) => !over.has(`${id} ${name}`))),
  });
  const take = (answer: StopAnswer) => {
    if (over.has(answer.id)) return;
    set({ answer: without(answer), pending: get().pending?.id === answer.id ? null : get().pending });
    clearTimeout(forget);
    forget = setTimeout(() => set({ answer: null }), TOLD_MS);
  };
  // Somebody else may release a robot while the answer still stands: the live stream tells.
  useLive.subscribe(({ world }, before) => {
    const { answer } = get();
    const isReleased = (name: string) => isHeld(before.world.robots[name]) && world.robots[name] && !isHeld(world.robots[name]);
    const released = Object.keys(answer?.robots ?? {}).filter(isReleased);
    if (!answer || released.length === 0) return;
    released.forEach((name) => over.add(`${answer.id} ${name}`));
    set({ answer: without(answer) });
  });
  hearStopLine(take, () => {
    const { pending } = get();
    if (pending && waits(pending.id)) stopOnLine(pending.targets, pending.id);
  });

  return {
    pending: null,
    answer: null,
    stop: async (targets) => {
      const now = Date.now();
      if (isAgain(get().pending, targets, now)) return;
      const id = crypto.randomUUID();
      pressed.add(id);
      const mayReach = stopOnLine(targets, id) || useLive.getState().connection === 'connected';
      set({ pending: { id, targets, sinceMs: now, state: mayReach ? 'sending' : 'late' } });
      setTimeout(() => late(id), LATE_MS);
      while (waits(id)) {
        try {
          take(await sendStop(targets, id));
        } catch (error) {
          if (!(error instanceof ApiError)) throw error;
          late(id);
          await pause(RETRY_MS);
        }
      }
    },
    reset: async (targets) => {
      const before = [...pressed];
      await sendReset(targets, crypto.randomUUID());
      before.forEach((id) => over.add(id));
      set({ pending: null, answer: null });
    },
    callOff: () => set({ pending: null }),
  };
});

warnOfLeaving(() => useStopping.getState().pending !== null);

const isHeld = (robot: RobotView | undefined) => robot !== undefined && (robot.stop.state !== 'none' || robot.state === 'stopped');

const isAgain = (before: Press | null, targets: readonly string[], now: number) =>
  before !== null &&
  now - before.sinceMs < DOUBLE_MS &&
  before.targets.join('\n') === targets.join('\n');

/** One robot that is stopped, and what is known of it. */
export interface StoppedRobot {
  name: string;
  fate: Fate;
  stop: RobotView['stop'];
}

const NO_STOP: RobotView['stop'] = { state: 'none', id: '', sent_unix_ms: 0, at_rest_unix_ms: 0, release: 'none' };
const FATES: Record<RobotView['stop']['state'], Fate> = {
  none: 'sent',
  sent: 'sent',
  received: 'sent',
  at_rest: 'stands',
  moves: 'moves',
  silent: 'silent',
};

/** Robots that an emergency stop holds: what the live stream tells, and sooner what the stop itself was answered. */
export function stoppedRobots(
  robots: Readonly<Record<string, RobotView>>,
  answer: StopAnswer | null = null,
): StoppedRobot[] {
  const names = new Set([
    ...Object.values(robots)
      .filter(isHeld)
      .map((robot) => robot.name),
    ...Object.keys(answer?.robots ?? {}),
  ]);
  return [...names].map((name) => {
    const robot = robots[name];
    const stop = robot?.stop ?? NO_STOP;
    const live = robot?.state === 'stopped' && stop.state === 'none' && robot.at_rest === true ? 'stands' : FATES[stop.state];
    const told = answer?.robots[name];
    const isNewer = told !== undefined && live === 'sent';
    return { name, fate: isNewer ? told : live, stop };
  });
}
