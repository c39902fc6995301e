import { describe, expect, it } from 'vitest';

import { ago, inWords } from './words';

describe('words', () => {
  it('say how long ago something was', () => {
    expect(ago(-500, 'en')).toBe('now');
    expect(ago(12_000, 'en')).toBe('12 seconds ago');
    expect(ago(61_000, 'en')).toBe('1 minute ago');
    expect(ago(26 * 3_600_000, 'en')).toBe('yesterday');
    expect(ago(3 * 86_400_000, 'en')).toBe('3 days ago');
  });

  it('are made of names', () => {
    expect(inWords('GoToPlace')).toBe('Go to place');
    expect(inWords('box_place')).toBe('Box place');
  });
});
