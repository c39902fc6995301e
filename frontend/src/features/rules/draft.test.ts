import { describe, expect, it } from 'vitest';

import type { Rule } from '@/live/types';
import { around, areaOf, idFor, outline, readCorners, writeCorners } from '@/ui/corners';

import { draftOf, ruleOf } from './draft';

const store = {
  id: 'store',
  kind: 'keep_out',
  name: 'storeroom',
  rectangle: [4, -1, 6, 1],
  robots: ['Ada', 'Bob'],
  exempt: ['supervisor'],
  when: { days: ['mon'], from: '22:00', to: '06:00' },
  words: 'never go there',
  by: 'Kim',
} as unknown as Rule;

describe('a rule in the form', () => {
  it('comes back as it was, with what the form does not show', () => {
    expect(ruleOf(draftOf(store), store, 'store')).toEqual({ ...store, map: '', polygon: null });
  });

  it('says only what its kind knows', () => {
    const speed = ruleOf({ ...draftOf(store), kind: 'speed', speed: '0,5' }, null, 'fast');
    expect(speed).toMatchObject({ kind: 'speed', max_speed_mps: 0.5, robots: ['Ada'] });
    expect(speed).not.toHaveProperty('rectangle');
    const classes = ruleOf({ ...draftOf(null), kind: 'action', what: ':moves' }, null, 'a');
    expect(classes).toMatchObject({ classes: ['moves'], verdict: 'forbid', when: null });
  });

  it('gets an id of its own', () => {
    expect(idFor('keep_out Ward 3', [{ ...store, id: 'keep-out-ward-3' }])).toBe('keep-out-ward-3-2');
  });
});

describe('corners', () => {
  it('are read as they are written', () => {
    expect(readCorners('1,2  4,2;4,5')).toEqual([[1, 2], [4, 2], [4, 5]]);
    expect(readCorners('1,2 4')).toBeNull();
    expect(readCorners('1,x')).toBeNull();
    expect(writeCorners([[1.2345, -2]])).toBe('1.23,-2');
  });

  it('are a rectangle if there are two', () => {
    expect(areaOf([[1, 2], [3, 4]])).toEqual({ rectangle: [1, 2, 3, 4], polygon: null });
    expect(outline([[1, 2], [3, 4]])).toEqual([[1, 2], [3, 2], [3, 4], [1, 4]]);
    expect(areaOf([[0, 0], [1, 0], [0, 1]]).polygon).toHaveLength(3);
  });

  it('leave some room around a thing', () => {
    expect(around({ id: 'b', kind: 'box', description: '', x: 1, y: 1, width: 1, height: 0.4, aliases: [], found: false })).toEqual([[0.2, 0.5], [1.8, 1.5]]);
  });
});
