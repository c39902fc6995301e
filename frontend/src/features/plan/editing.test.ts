import { describe, expect, it } from 'vitest';

import { ability, step } from '@/live/samples';

import { addables, callsOf, editable, inputsOf, moved, nameOfAction, newStep, nudged, pendingSteps, rebased, setInput, sinceThen, toDrafts, type DraftStep } from './editing';

const toDraft = (one: ReturnType<typeof step>) => toDrafts([one])[0] as DraftStep;
const drafts = ['a', 'b', 'c'].map((id) => toDraft(step({ id })));
const ids = (steps: readonly { id: string }[]) => steps.map((one) => one.id).join('');

describe('changing a plan', () => {
  it('offers only steps that have not begun', () => {
    const steps = [step({ id: 'a', state: 'finished' }), step({ id: 'b', state: 'running' }), step({ id: 'c' })];
    expect(ids(pendingSteps(steps))).toBe('c');
  });

  it('knows the steps again after a restart, and which of them wait once more', () => {
    const named = (ids: string, planned = '') => [...ids].map((id) => step({ id, planned: planned + id, label: id }));
    const [first, ...rest] = named('abc');
    if (!first) throw new Error('there are three');
    const then = [{ ...first, state: 'running' as const }, ...rest];
    const after = sinceThen(then, named('abc', 'new '));
    expect([after.isSame, ids(after.again), after.begun]).toEqual([true, 'a', []]);
    expect(sinceThen(then, named('acb', 'new ')).isSame).toBe(false);
    expect(sinceThen(then, named('abcd', 'new ')).isSame).toBe(false);
    const later = sinceThen(then, [{ ...first, state: 'finished' }, { ...(rest[0] ?? first), state: 'running' }, ...rest.slice(1)]);
    expect([later.isSame, later.again, later.begun]).toEqual([true, [], ['b']]);
  });

  it('takes what one changed over into what others made of the plan', () => {
    const named = (ids: string) => [...ids].map((id) => step({ id, planned: id, label: id }));
    const mine = (order: string) => [...order].map((id) => toDrafts(named('abcd')).find((one) => one.id === id) as DraftStep);
    expect(ids(rebased(named('abcd'), mine('abdc'), named('abcd')))).toBe('abdc');
    expect(ids(rebased(named('abcd'), mine('dbc'), named('axbcd')))).toBe('xdbc'); // a is out: behind it is first
    expect(ids(rebased(named('abcd'), mine('abdc'), named('acdx')))).toBe('adcx');
    expect(ids(rebased(named('abcd'), [...mine('ba'), { ...(mine('c')[0] as DraftStep), id: 'new' }], named('bcd')))).toBe('bnew');
    const otherwise = (id: string, value: string) => step({ id, planned: id, call: { Go: value } as never });
    const [theirs] = rebased([otherwise('a', 'box')], [toDraft(otherwise('a', 'box'))], [otherwise('a', 'door')]);
    const [own] = rebased([otherwise('a', 'box')], [toDraft(otherwise('a', 'sofa'))], [otherwise('a', 'door')]);
    expect([theirs?.call, own?.call]).toEqual([{ Go: 'door' }, { Go: 'sofa' }]);
  });

  it('moves steps before and behind others', () => {
    expect(ids(moved(drafts, new Set(['c']), 'a', 'before'))).toBe('cab');
    expect(ids(moved(drafts, new Set(['a']), 'b', 'after'))).toBe('bac');
    expect(ids(moved(drafts, new Set(['a']), 'a', 'after'))).toBe('abc');
  });

  it('moves a step by one place and not past the ends', () => {
    expect(ids(nudged(drafts, 'b', -1))).toBe('bac');
    expect(ids(nudged(drafts, 'a', -1))).toBe('abc');
    expect(ids(nudged(drafts, 'c', 1))).toBe('abc');
  });

  it('keeps the search for a place with the step that goes there', () => {
    const place = [{ name: 'pose::position::x', type: 'number', value: null }];
    const named = [{ name: 'name', type: 'string', value: 'box' }];
    const find = { Find: { input_parameters: { name: { pvf_type: 'string', pvf_value: 'box' } } } };
    const steps = [
      step({ id: 'find', only_finds: true, inputs: named, outputs: place, call: find }),
      step({ id: 'go', inputs: place, call: { Go: {} } }),
      step({ id: 'say', call: { Say: {} } }),
    ];
    const [go, say] = toDrafts(steps) as [DraftStep, DraftStep];
    expect(inputsOf(go).map((input) => input.value)).toEqual(['box']);
    const sent = callsOf(moved([setInput(go, 'name', 'door'), say], new Set(['say']), 'go', 'before'));
    expect(sent).toEqual([{ Say: {} }, { Find: { input_parameters: { name: { pvf_type: 'string', pvf_value: 'door' } } } }, { Go: {} }]);
  });

  it('writes a new value where the wire expects it and leaves the rest alone', () => {
    const call = {
      Look: {
        input_parameters: { what: { pvf_type: 'string', pvf_value: 'box' }, far: { pvf_type: 'bool' } },
        reason: 'to see',
      },
    };
    const draft = toDraft(step({ id: 'a', inputs: [{ name: 'what', type: 'string', value: 'box' }], call }));
    expect(setInput(draft, 'what', 'chair').call).toEqual({
      Look: {
        input_parameters: { what: { pvf_type: 'string', pvf_value: 'chair' }, far: { pvf_type: 'bool' } },
        reason: 'to see',
      },
    });
  });

  it('adds a drive with the search for its place, and says where it leads to', () => {
    const goTo = ability({ name: 'GoTo', inputs: { 'pose::position::x': 'number' }, label: 'Go to {place}' });
    const find = ability({ name: 'Find', inputs: { what: 'string' }, outputs: { 'pose::position::x': 'number' }, effects: ['locates'], label: 'Find {what}' });
    const wait = ability({ name: 'Wait', inputs: { time: 'number' }, label: 'Wait for {time} seconds' });
    const found = addables([find, goTo, wait]);
    expect(found.map(({ action }) => nameOfAction(action))).toEqual(['Go to …', 'Wait for … seconds']);
    const [drive, pause] = found.map((one) => newStep(one, 'n'));
    if (!drive || !pause) throw new Error('there are two');
    const there = setInput(drive, 'what', 'red box');
    expect(there.label).toBe('Go to “red box”');
    expect(callsOf([there])).toEqual([
      { Find: { input_parameters: { what: { pvf_type: 'string', pvf_value: 'red box' } }, output_parameters: { pose: { position: { x: { pvf_type: 'number' } } } } } },
      { GoTo: { input_parameters: { pose: { position: { x: { pvf_type: 'number' } } } }, output_parameters: {} } },
    ]);
    expect(setInput(pause, 'time', 5).label).toBe('Wait for 5 seconds');
  });

  it('says of a changed step what it is changed to', () => {
    const draft = toDraft(step({ id: 'a', label: 'Mine kohta “box”', inputs: [{ name: 'what', type: 'string', value: 'box' }] }));
    expect(setInput(draft, 'what', 'door').label).toBe('Mine kohta “door”');
  });

  it('lets people write words, not coordinates', () => {
    expect(editable({ name: 'what', type: 'string', value: '' })).toBe(true);
    expect(editable({ name: 'pose::position::x', type: 'number', value: 1 })).toBe(false);
    expect(editable({ name: 'picture', type: 'image', value: null })).toBe(false);
  });
});
