import { describe, expect, it } from 'vitest';

import { step } from '@/live/samples';
import type { StepState, StepView } from '@/live/types';

import { putBack } from './putting-back';

const looks = (id: string) => step({ id, planned: id, risk: 'looks_and_speaks' });
const goes = (id: string) => step({ id, planned: id, risk: 'moves' });
const inState = (steps: readonly StepView[], states: Record<string, StepState>) =>
  steps.map((one) => ({ ...one, state: states[one.id] ?? one.state }));
const named = (steps: readonly StepView[], ids: string) => steps.filter(({ id }) => ids.includes(id));
const told = ({ steps, undoes }: ReturnType<typeof putBack>) => [steps.map(({ id }) => id).join(''), undoes.join('')];

describe('putting steps back', () => {
  const plan = ['a', 'b', 'c', 'd'].map(looks);

  it('makes the plan what it was, and lets make way what was begun instead', () => {
    const now = inState(plan, { a: 'skipped', b: 'running' });
    expect(told(putBack(named(plan, 'a'), plan, now))).toEqual(['abcd', 'ab']);
    expect(told(putBack(named(plan, 'ab'), plan, inState(now, { b: 'skipped', c: 'paused' })))).toEqual(['abcd', 'abc']);
  });

  it('leaves alone what is done, and what was not begun in its place', () => {
    expect(told(putBack(named(plan, 'a'), plan, inState(plan, { a: 'skipped', b: 'finished', c: 'running' })))).toEqual(['acd', 'ac']);
    expect(told(putBack(named(plan, 'b'), plan, named(inState(plan, { a: 'running' }), 'acd')))).toEqual(['bcd', 'b']);
    expect(told(putBack(named(plan, 'd'), plan, named(inState(plan, { a: 'running' }), 'abc')))).toEqual(['bcd', 'd']);
    expect(told(putBack(named(plan, 'd'), plan, []))).toEqual(['d', 'd']);
  });

  it('takes the search for a place along with the way that it is for', () => {
    const pose = [{ name: 'pose::position::x', type: 'number', value: null }];
    const way = (id: string) => [
      step({ id, planned: id, risk: 'looks_and_speaks', only_finds: true, outputs: pose }),
      { ...goes(id.toUpperCase()), inputs: pose },
    ];
    const steps = ['a', 'b'].flatMap(way);
    const begun: Record<string, StepState>[] = [{ b: 'finished', B: 'running' }, { b: 'running' }, { b: 'finished' }];
    for (const states of begun) {
      const now = inState(steps, { a: 'finished', A: 'skipped', ...states });
      expect(told(putBack(named(steps, 'aA'), steps, now))).toEqual(['aAbB', 'aAbB']);
    }
  });

  it('has what is done at the end of a way done there', () => {
    const ways = ['A', 'B', 'C'].flatMap((id) => [goes(id), looks(id.toLowerCase())]);
    const underWay = inState(ways, { A: 'finished', a: 'skipped', B: 'running' });
    expect(told(putBack(named(ways, 'a'), ways, underWay))).toEqual(['AaBbCc', 'aB']);
    const there = inState(underWay, { B: 'finished', b: 'running' });
    expect(told(putBack(named(ways, 'a'), ways, there))).toEqual(['AaBbCc', 'ab']);
    expect(told(putBack(named(ways, 'aB'), ways, inState(there, { B: 'skipped' })))).toEqual(['AaBbCc', 'aBb']);
    expect(told(putBack(named(ways, 'b'), ways, named(there, 'AaBCc')))).toEqual(['bCc', 'b']);
  });
});
