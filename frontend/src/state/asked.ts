/** What robots wait for a person to answer. */
import { useMemo } from 'react';

import { askedOf } from '@/live/questions';
import { useWorld } from '@/live/store';
import type { ChatEntry } from '@/live/types';

/** All that was asked in words and is not answered, newest last; also what a robot offers whose plan waits for help. */
export function useAsked(): readonly ChatEntry[] {
  const chat = useWorld((world) => world.chat);
  const plans = useWorld((world) => world.plans);
  return useMemo(() => {
    const helpless = Object.values(plans).filter((plan) => plan.state === 'held').map((plan) => plan.robot);
    return askedOf(chat, new Set(helpless));
  }, [chat, plans]);
}
