/** Stopping: pressed here, confirmed by the robots. A stop that does not get through is tried again, and said so. */
import { create } from 'zustand';

import { ApiError, sendStop } from '@/live/api';
import type { RobotView } from '@/live/types';

interface Stopping {
  /** A stop of this page that the server has not taken yet. */
  pending: { id: string; targets: readonly string[]; failed: boolean } | null;
  /** @param targets Names of robots; empty: all. */
  stop: (targets: readonly string[]) => Promise<void>;
  /** @throws ApiError The server refused, or was not reached. */
  reset: (targets: readonly string[]) => Promise<void>;
}

const RETRY_MS = 700;
const ATTEMPTS = 60;

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

export const useStopping = create<Stopping>()((set, get) => ({
  pending: null,
  stop: async (targets) => {
    const id = crypto.randomUUID();
    set({ pending: { id, targets, failed: false } });
    for (let attempt = 0; attempt < ATTEMPTS && get().pending?.id === id; attempt += 1) {
      try {
        await sendStop('stop', targets, id);
        if (get().pending?.id === id) set({ pending: null });
        return;
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (get().pending?.id === id) set({ pending: { id, targets, failed: true } });
        await pause(RETRY_MS);
      }
    }
  },
  reset: async (targets) => {
    await sendStop('reset', targets, crypto.randomUUID());
    set({ pending: null });
  },
}));

/** Robots that an emergency stop holds. */
export const stoppedRobots = (robots: Readonly<Record<string, RobotView>>): RobotView[] =>
  Object.values(robots).filter((robot) => robot.stop.state !== 'none' || robot.state === 'stopped');
