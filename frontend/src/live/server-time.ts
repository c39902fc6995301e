/** How far this device's clock is from the server's, so that ages of pictures are right on a phone set wrong. */
const SURE_MS = 1500; // the server tells its time in whole seconds, and answers take a while

let aheadMs = 0;

/** Learn from the `Date` of an answer. */
export function noteServerDate(date: string | null, nowUnixMs: number): void {
  const server = Date.parse(date ?? '');
  if (Number.isNaN(server)) return;
  const difference = server - nowUnixMs;
  aheadMs = Math.abs(difference) < SURE_MS ? 0 : difference;
}

/** A time of this device as the server's clock shows it. */
export const onServerClock = (unixMs: number): number => unixMs + aheadMs;
