/** What robots wait for a person to answer. */
import { useMemo } from 'react';

import { askedOf, openQuestions, type Questions } from '@/live/questions';
import { useWorld } from '@/live/store';
import type { ChatEntry, PlanView } from '@/live/types';

import { answeredIn, useOutbox } from './outbox';

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

/** The newest question of each robot that what is written next would answer. */
export function useOpenQuestions(): Questions {
  const chat = useWorld((world) => world.chat);
  const onTheirWay = useOutbox((outbox) => outbox.messages);
  return useMemo(() => openQuestions(chat, answeredIn(onTheirWay)), [chat, onTheirWay]);
}
