/** Which box over the page is open. */
import { create } from 'zustand';

export type Overlay = 'none' | 'commands' | 'shortcuts' | 'addRobot' | 'favourites';

interface Overlays {
  open: Overlay;
  set: (open: Overlay) => void;
}

export const useOverlays = create<Overlays>()((set) => ({ open: 'none', set: (open) => set({ open }) }));
