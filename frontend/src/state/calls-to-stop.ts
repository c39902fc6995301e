/** What stops have in common, pressed and written: they are sent until they get through. */
import type { World } from '@/live/world';

export const RETRY_MS = 500;
/** A stop that the server did not take for so long is said to be late. */
export const LATE_MS = 700;
/** With more words besides it may be an order for a place or a time, which must not arrive late unasked. */
const FEW_WORDS = 2;

export const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

/** Only this page goes on sending a stop that was not taken: whoever closes it then is asked. */
export const warnOfLeaving = (isNeeded: () => boolean) =>
  window.addEventListener('beforeunload', (event) => {
    if (isNeeded()) event.preventDefault();
  });

/** Whether a message calls robots to stop and says hardly anything else. */
export function callsToStop(text: string, { info, robots }: Pick<World, 'info' | 'robots'>): boolean {
  if (!info?.stop_words) return false;
  const word = new RegExp(`(?<![\\p{L}\\p{N}_-])(?:${info.stop_words})(?![\\p{L}\\p{N}_])`, 'giu');
  const named = Object.keys(robots).reduce((rest, name) => rest.replaceAll(name, ' '), text.normalize('NFKC'));
  const rest = named.replace(word, ' ');
  return rest !== named && (rest.match(/[\p{L}\p{N}'’]+/gu)?.length ?? 0) <= FEW_WORDS;
}
