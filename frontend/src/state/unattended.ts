/** What robots do with an order when nobody is connected any more, as chosen for the orders of this page. */
import { create } from 'zustand';

import type { Unattended } from '@/live/api';

interface Chosen {
  /** Null: as the system does otherwise. */
  choice: Unattended | null;
  choose: (choice: Unattended) => void;
}

export const useUnattended = create<Chosen>()((set) => ({ choice: null, choose: (choice) => set({ choice }) }));
