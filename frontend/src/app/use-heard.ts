import { useEffect, useMemo, useRef } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { World } from '@/live/world';
import { askedIn, useAsked } from '@/state/asked';
import { usePrefs } from '@/state/prefs';
import { useToasts } from '@/state/toasts';
import { nameList } from '@/ui/words';

const NAME = 'Parley';
/** After this time without an answer people are called once more, and again after each further one. */
export const AGAIN_MS = 3 * 60_000;
const TONE_HZ = 660;
const TONE_S = 0.35;
const BUZZ_MS = [200, 100, 200];

/** What waits for a person: id -> who asks. */
function useWaiting(): ReadonlyMap<string, readonly string[]> {
  const proposals = useWorld((world) => world.proposals);
  const asked = useAsked();
  return useMemo(
    () =>
      new Map<string, readonly string[]>([
        ...Object.values(proposals).map((one) => [one.id, [one.robot]] as const),
        ...asked.map((one) => [one.id, one.targets] as const),
      ]),
    [proposals, asked],
  );
}

/** Makes a robot that waits heard: by the page's title, and where the person wants that by sound, buzzing and the system's notes. */
export function useHeard(): void {
  const { t, i18n } = useTranslation('menu');
  const waiting = useWaiting();
  const loud = usePrefs((prefs) => prefs.loud);
  const show = useToasts((state) => state.show);
  const known = useRef<ReadonlyMap<string, readonly string[]> | null>(null);
  useEffect(() => {
    document.title = waiting.size > 0 ? `(${waiting.size}) ${NAME}` : NAME;
    const fresh = [...waiting].filter(([id]) => known.current && !known.current.has(id));
    known.current = waiting;
    const [first] = fresh;
    if (loud && first) call(t('waitsNow', { name: nameList(first[1], i18n.language) }));
  }, [waiting, loud, t, i18n.language]);

  const who = nameList([...new Set([...waiting.values()].flat())], i18n.language);
  const ids = [...waiting.keys()].join('\n');
  useEffect(() => {
    if (!ids) return undefined;
    const timer = setInterval(() => {
      const still = ids.split('\n');
      const stands = ({ world }: { world: World }) => still.some((id) => id in world.proposals || askedIn(world).some((one) => one.id === id));
      show({ tone: 'error', message: t('waitsLong', { name: who }), stands });
      if (loud) call(t('waitsLong', { name: who }));
    }, AGAIN_MS);
    return () => clearInterval(timer);
  }, [ids, who, loud, show, t]);
}

/** By every means there is; each may be missing or not allowed. */
function call(message: string): void {
  if ('vibrate' in navigator) navigator.vibrate(BUZZ_MS);
  sound();
  if (document.hidden && 'Notification' in window && Notification.permission === 'granted') void note({ body: message, tag: NAME });
}

/** Phones show notes of a page's worker alone and refuse those that a page makes itself; elsewhere there may be no worker. */
async function note(told: NotificationOptions): Promise<void> {
  const worker = 'serviceWorker' in navigator ? await navigator.serviceWorker.getRegistration().catch(() => undefined) : undefined;
  if (worker) await worker.showNotification(NAME, told).catch(() => undefined);
  else new Notification(NAME, told);
}

function sound(): void {
  if (!('AudioContext' in window)) return;
  const audio = new AudioContext();
  const tone = audio.createOscillator();
  const volume = audio.createGain();
  tone.frequency.value = TONE_HZ;
  volume.gain.setValueAtTime(0.25, audio.currentTime);
  volume.gain.exponentialRampToValueAtTime(0.001, audio.currentTime + TONE_S);
  tone.connect(volume).connect(audio.destination);
  tone.onended = () => void audio.close();
  tone.start();
  tone.stop(audio.currentTime + TONE_S);
}
