import { afterEach, describe, expect, it } from 'vitest';

import { noteServerDate, onServerClock } from './server-time';

const NOON = Date.UTC(2026, 0, 2, 12);

afterEach(() => noteServerDate(new Date(NOON).toUTCString(), NOON));

describe('the clock of the server', () => {
  it('is followed by a device whose own is set wrong', () => {
    noteServerDate(new Date(NOON).toUTCString(), NOON - 3_600_000);
    expect(onServerClock(NOON - 3_600_000)).toBe(NOON);
  });

  it('is not guessed from less than a second or from nothing', () => {
    noteServerDate(new Date(NOON).toUTCString(), NOON + 900);
    expect(onServerClock(5)).toBe(5);
    noteServerDate(null, NOON);
    expect(onServerClock(5)).toBe(5);
  });
});
