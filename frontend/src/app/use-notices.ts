import { useEffect, useRef } from 'react';

import { useLive, useWorld } from '@/live/store';
import type { World } from '@/live/world';
import { moodOf } from '@/state/mood';
import { useToasts } from '@/state/toasts';

/** For so long at least one can read it: what it is about may still be on its way. */
export const LEAST_MS = 5000;
/** What stands elsewhere as long as it is so, lies over the page no longer than this. */
export const MOST_MS = 15_000;

/** Shows what was refused, once each. */
export function useNotices(): void {
  const notices = useWorld((world) => world.notices);
  const show = useToasts((state) => state.show);
  const shown = useRef(0);
  useEffect(() => {
    for (const notice of notices.filter((one) => one.id > shown.current)) {
      shown.current = notice.id;
      const { robot } = notice;
      const message = notice.message.startsWith(robot) ? notice.message : `${robot}: ${notice.message}`;
      show({ tone: 'error', message, stands: whileItIsSo(robot, useLive.getState().world) });
    }
  }, [notices, show]);
}

/** Until a stopped robot is released; until another begins or has done what it was at, or is told something else. */
function whileItIsSo(robot: string, then: World): (live: { world: World }) => boolean {
  const mood = moodOf(robot, then);
  const [said, began] = [lastSaidTo(robot, then), Date.now()];
  if (mood === 'stopped') return ({ world }) => moodOf(robot, world) === 'stopped' && Date.now() < began + MOST_MS;
  return ({ world }) => {
    const now = moodOf(robot, world);
    const isOver = now !== mood && (now === 'running' || now === 'idle');
    return Date.now() < began + LEAST_MS || (!isOver && lastSaidTo(robot, world) === said);
  };
}

const lastSaidTo = (robot: string, { chat }: World) => chat.findLast((entry) => entry.who === 'operator' && entry.targets.includes(robot))?.id;
