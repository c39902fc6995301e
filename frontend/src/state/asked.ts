/** What robots wait for a person to answer. */
import { useMemo } from 'react';

import { askedOf } from '@/live/questions';
import { useWorld } from '@/live/store';
import type { ChatEntry, PlanView } from '@/live/types';

interface Seen {
  chat: readonly ChatEntry[];
  plans: Readonly<Record<string, PlanView>>;
}

/** All that was asked in words and is not answered, newest last; also what a robot offers whose plan waits for help. */
export function askedIn({ chat, plans }: Seen): readonly ChatEntry[] {
  const helpless = Object.values(plans).filter((plan) => plan.state === 'held').map((plan) => plan.robot);
  return askedOf(chat, new Set(helpless));
}

/** The same now. */
export function useAsked(): readonly ChatEntry[] {
  const chat = useWorld((world) => world.chat);
  const plans = useWorld((world) => world.plans);
  return useMemo(() => askedIn({ chat, plans }), [chat, plans]);
}
