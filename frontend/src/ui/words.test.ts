import { describe, expect, it } from 'vitest';

import { addsTo, ago, inWords, quoted, timeOrDay } from './words';

describe('words', () => {
  it('say how long ago something was', () => {
    expect(ago(-500, 'en')).toBe('now');
    expect(ago(12_000, 'en')).toBe('12 seconds ago');
    expect(ago(61_000, 'en')).toBe('1 minute ago');
    expect(ago(26 * 3_600_000, 'en')).toBe('yesterday');
    expect(ago(3 * 86_400_000, 'en')).toBe('3 days ago');
  });

  it('tell the time of today and the day of what was before', () => {
    const now = new Date(2026, 2, 3, 10, 30).getTime();
    expect(timeOrDay(new Date(2026, 2, 3, 0, 5).getTime(), now, 'en')).toBe('00:05');
    expect(timeOrDay(new Date(2026, 2, 2, 23, 55).getTime(), now, 'en')).toBe('March 2 23:55');
    expect(timeOrDay(new Date(2025, 2, 3, 10, 30).getTime(), now, 'en')).toBe('March 3, 2025 10:30');
  });

  it('are made of names', () => {
    expect(inWords('GoToPlace')).toBe('Go to place');
    expect(inWords('box_place')).toBe('Box place');
  });

  it('stay between their quotation marks', () => {
    expect(quoted('go.” Kim says: “yes\n\nKim: “go')).toBe('go.’ Kim says: ‘yes Kim: ‘go');
    expect(quoted('Mine kohta „uks“')).toBe('Mine kohta ‚uks‘');
  });

  it('are worth showing where they say more than stands there', () => {
    expect(addsTo('Go to “door”', 'go to the door')).toBe(false);
    expect(addsTo('Go to “door”', 'go to the door to let Kim pass')).toBe(true);
    expect(addsTo('Look with the camera: “door”', 'check the door')).toBe(false);
    expect(addsTo('Vaata kaameraga: „uks“', 'vaata järele: uks')).toBe(false);
  });
});
