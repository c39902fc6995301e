import { useEffect, useRef } from 'react';

import { useWorld } from '@/live/store';
import { useToasts } from '@/state/toasts';

/** Shows what was refused, once each. */
export function useNotices(): void {
  const notices = useWorld((world) => world.notices);
  const show = useToasts((state) => state.show);
  const shown = useRef(0);
  useEffect(() => {
    for (const notice of notices.filter((one) => one.id > shown.current)) {
      shown.current = notice.id;
      show({ tone: 'error', message: [notice.robot, notice.message].filter(Boolean).join(': ') });
    }
  }, [notices, show]);
}
