/** Whether this browser offers to keep the page like an app. */
import { create } from 'zustand';

/** Not in TypeScript's library yet. */
interface InstallOffer extends Event {
  prompt: () => Promise<unknown>;
}

interface Install {
  offer: InstallOffer | null;
  set: (offer: InstallOffer | null) => void;
}

export const useInstall = create<Install>()((set) => ({ offer: null, set: (offer) => set({ offer }) }));

/** Begin to listen; the offer comes once, and early. */
export function listenForOffer(): void {
  window.addEventListener('beforeinstallprompt', (event) => {
    event.preventDefault();
    useInstall.getState().set(event as InstallOffer);
  });
  window.addEventListener('appinstalled', () => useInstall.getState().set(null));
}

/** Whether it runs like an app already. */
export const isInstalled = (): boolean => window.matchMedia?.('(display-mode: standalone)').matches ?? false;
