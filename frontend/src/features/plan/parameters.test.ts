import { describe, expect, it } from 'vitest';

import { step } from '@/live/samples';
import type { ParameterInfo } from '@/live/types';

import { labelOf, rowsOf, withReceived } from './parameters';

const number = (name: string, value: number | null) => ({ name, type: 'number', value });

describe('values of a step', () => {
  it('draws the coordinates of a place together', () => {
    const rows = rowsOf([
      number('pose::position::x', 1.5),
      number('pose::position::y', 2),
      number('pose::position::z', 0),
      number('pose::orientation::y', Math.PI / 2),
      { name: 'what_to_see', type: 'string', value: 'a box' },
    ]);
    expect(rows).toEqual([
      { kind: 'value', name: 'what_to_see', label: 'What to see', value: 'a box' },
      { kind: 'place', name: 'pose', label: '', x: 1.5, y: 2, degrees: 90 },
    ]);
  });

  it('calls an input what it means, in few words, and what says nothing of it by its name', () => {
    const about: ParameterInfo = { kind: 'text', unit: '', default: null, choices: [], help: '' };
    expect(labelOf('inspect', { ...about, help: 'What to look at, in a few words.' })).toBe('What to look at');
    expect(labelOf('box_place', about)).toBe('Box place');
  });

  it('says when a place or value is not known yet', () => {
    const rows = rowsOf([number('pose::position::x', null), { name: 'answer', type: 'string', value: null }]);
    expect(rows.map((row) => (row.kind === 'value' ? row.value : 'place'))).toEqual([null, null]);
  });

  it('tells what a step that has begun got from the one before, and nothing of one that has not', () => {
    const wanted = { inputs: [number('x', null)], outputs: [] };
    const steps = withReceived([
      step({ id: 'a', state: 'finished', inputs: [], outputs: [number('x', 3)] }),
      step({ id: 'b', state: 'running', ...wanted }),
      step({ id: 'c', state: 'queued', ...wanted }),
    ]);
    expect(steps.map(({ inputs }) => inputs[0]?.value)).toEqual([undefined, 3, null]);
  });
});
