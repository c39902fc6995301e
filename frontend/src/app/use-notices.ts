import { useEffect, useRef } from 'react';

import { useLive, useWorld } from '@/live/store';
import type { World } from '@/live/world';
import { moodOf } from '@/state/mood';
import { useToasts } from '@/state/toasts';

/** Shows what was refused, once each. */
export function useNotices(): void {
  const notices = useWorld((world) => world.notices);
  const show = useToasts((state) => state.show);
  const shown = useRef(0);
  useEffect(() => {
    for (const notice of notices.filter((one) => one.id > shown.current)) {
      shown.current = notice.id;
      const { robot } = notice;
      const isStopped = moodOf(robot, useLive.getState().world) === 'stopped';
      const stands = ({ world }: { world: World }) => moodOf(robot, world) === 'stopped';
      const message = notice.message.startsWith(robot) ? notice.message : `${robot}: ${notice.message}`;
      show({ tone: 'error', message, ...(isStopped && { stands }) });
    }
  }, [notices, show]);
}
