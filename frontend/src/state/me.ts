/** Who this visitor is, and what they may do. */
import { create } from 'zustand';

import type { SessionInfo } from '@/live/types';

/** What the server lets people do or not; see docs/people.md. */
export type Effect =
  | 'speak'
  | 'reset'
  | 'resume'
  | 'approve'
  | 'edit'
  | 'clear'
  | 'remember'
  | 'forget'
  | 'policy'
  | 'rule'
  | 'map'
  | 'setting'
  | 'people'
  | 'audit';

interface Me {
  /** Null until the server told. */
  session: SessionInfo | null;
  take: (session: SessionInfo) => void;
}

export const useMe = create<Me>()((set) => ({ session: null, take: (session) => set({ session }) }));

const allows = (session: SessionInfo | null, effect: Effect) => session === null || session.may.includes(effect);

/** Whether this visitor may do something; the server has the last word. */
export const useMay = (effect: Effect) => useMe(({ session }) => allows(session, effect));

/** The same for several at once. */
export function useMayAll(): (effect: Effect) => boolean {
  const session = useMe((me) => me.session);
  return (effect) => allows(session, effect);
}
