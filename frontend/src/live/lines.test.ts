import { describe, expect, it } from 'vitest';

import { step } from './samples';
import type { StepState } from './types';

import { linesOf } from './lines';

const place = [{ name: 'pose::position::x', type: 'number', value: null }];
const find = (id: string, state: StepState = 'queued') => step({ id, state, only_finds: true, outputs: place, worked_ms: 400 });
const go = (id: string, state: StepState = 'queued') => step({ id, state, inputs: place, worked_ms: 1000 });
const shown = (...steps: Parameters<typeof linesOf>[0][number][]) => linesOf(steps).map((line) => `${line.step.id} ${line.step.state} ${line.step.worked_ms}`);

describe('the lines of a plan', () => {
  it('take the search for a place into the step that goes there', () => {
    expect(shown(find('a', 'finished'), go('b', 'finished'), find('c', 'running'), go('d'))).toEqual([
      'b finished 1400',
      'd running 1400',
    ]);
  });

  it('say of a step whose place is not found how the search for it fares', () => {
    const failed = { ...find('a', 'failed'), message: 'Two fit.' };
    expect(linesOf([failed, go('b')]).map(({ step: { id, state, message } }) => [id, state, message])).toEqual([['b', 'failed', 'Two fit.']]);
    expect(shown(find('a', 'paused'), go('b'), find('c', 'failed'), go('d', 'skipped'))).toEqual(['b paused 1400', 'd skipped 1400']);
  });

  it('show a search that was asked for on its own', () => {
    expect(shown(find('a'), step({ id: 'say' }))).toEqual(['a queued 400', 'say queued 0']);
    expect(shown(find('a'))).toEqual(['a queued 400']);
  });
});
