import { act, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { ability, incident, mapInfo, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import type { PlanView, StepState } from '@/live/types';
import { useToasts } from '@/state/toasts';

import { PlanPanel } from './plan-panel';

const sent: { method: string; path: string; body: unknown }[] = [];
let status = 200;

beforeEach(() => {
  sent.length = 0;
  status = 200;
  vi.stubGlobal('fetch', (path: string, options: RequestInit) => {
    sent.push({ method: options.method ?? '', path, body: JSON.parse(String(options.body)) });
    return Promise.resolve(new Response(JSON.stringify(path.includes('/map/') ? mapInfo : {}), { status }));
  });
});

const call = (name: string) => ({ [name]: { input_parameters: {}, output_parameters: {} } });
const steps = [
  step({ id: 'one', state: 'finished' }),
  step({ id: 'two', state: 'running', progress: 0.25, progress_text: '3 m left', call: call('Two') }),
  step({ id: 'three', call: call('Three') }),
  step({ id: 'four', call: call('Four') }),
];

const show = (part: Partial<PlanView> = {}) => {
  useLive.getState().takeSnapshot(
    snapshot({ robots: [robot({ name: 'Ada' })], plans: [plan({ robot: 'Ada', revision: 7, steps, ...part })] }),
  );
  render(<PlanPanel />);
  return userEvent.setup();
};

const WAIT = { timeout: 10_000 }; // longer than what is on its way is waited for
vi.setConfig({ testTimeout: 20_000 });
describe('the plan', () => {
  it('says that somebody else decided about what one is changing', async () => {
    const proposal = { id: 'p', robot: 'Ada', message: '', why: '', changes: [], steps: [step({ id: 'go to the box', call: call('Go') })], digest: 'd', by: null };
    const user = show({ steps: [], state: 'awaiting_approval' });
    const propose = (seq: number) => act(() => useLive.getState().takeChanges([{ kind: 'proposal', seq, proposal }]));
    const gone = (seq: number) => act(() => useLive.getState().takeChanges([{ kind: 'proposal_gone', seq, id: 'p' }]));
    propose(1);
    gone(2);
    expect(useToasts.getState().toasts).toEqual([]);
    propose(3);
    await user.click(screen.getByRole('button', { name: 'Change' }));
    gone(4); // and nothing of it begins
    await vi.waitFor(() => expect(useToasts.getState().toasts.map(({ message }) => message)).toEqual([expect.stringContaining('Your change was not used.')]), WAIT);
  });

  it('does not say of a look that found something that it did not work', () => {
    const words = ['I can see a bag.', 'I cannot see the box.'] as const;
    show({ steps: words.map((message) => step({ id: message, state: 'failed', message })) });
    const codes = ['attention', 'no_match'] as const;
    act(() => useLive.getState().takeChanges(words.map((message, at) => ({ kind: 'incident', seq: at + 1, incident: incident({ id: message, code: codes[at] ?? 'internal', message }) }))));
    const state = (message: string) => screen.getByText(message, { selector: 'p' }).closest('li')?.textContent;
    expect(state(words[0])).toContain('Found something');
    expect(state(words[1])).toContain('Did not work');
  });

  it('tells the state of each step in words', () => {
    const states: StepState[] = ['queued', 'running', 'finished', 'failed', 'stopped', 'skipped', 'paused', 'stopping', 'waiting'];
    show({ steps: states.map((state) => step({ id: `step ${state}`, state })) });
    const words = ['Waiting its turn', 'Working on it', 'Done', 'Did not work', 'Stopped', 'Skipped', 'Paused', 'Stopping…', 'Waiting for your answer'];
    expect(words.filter((word) => screen.queryByText(word) === null)).toEqual([]);
  });

  it('says how far a step has come', () => {
    show();
    expect(screen.getByRole('progressbar').getAttribute('aria-valuenow')).toBe('25');
    expect(screen.getByText('3 m left')).toBeTruthy();
  });

  it('says how far the whole of it has come', () => {
    show();
    screen.getByText('Working, step 2 of 4');
  });

  it('says that what it shows may be past while the robot is not connected', () => {
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', connection: 'lost' })], plans: [plan({ robot: 'Ada', steps })] }));
    render(<PlanPanel />);
    screen.getByText(/^Ada is not connected/);
  });

  it('takes the reader to what is opened for changing, however long the list', async () => {
    const user = show();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    expect(document.activeElement).toBe(screen.getByRole('group', { name: 'Change the plan' }));
  });

  it('says in the words of the robot what a step is, rather than its name', async () => {
    const action = ability({ name: 'GoTo', description: 'Drive to a place.' });
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', catalogue: [action] })], plans: [plan({ robot: 'Ada', steps })] }));
    render(<PlanPanel />);
    await userEvent.setup().click(screen.getByRole('button', { name: /^2\. Two/ }));
    screen.getByText('Drive to a place.');
    expect(screen.queryByText('Go to')).toBeNull();
  });

  it.each<[string, object, string, Record<string, StepState>, string[], string[]]>([
    ['Cancel all', { command: 'clear' }, '3 steps were cancelled.', {}, ['Two', 'Three', 'Four'], ['two', 'three', 'four']],
    ['Skip', { command: 'skip', step: 'two' }, '“Two” is left out.', { two: 'skipped', three: 'running', four: 'queued' }, ['Two', 'Three', 'Four'], ['two', 'three']],
  ])('puts back what was lost by: %s', async (button, body, said, left, again, undoes) => {
    const user = show();
    await user.click(screen.getByRole('button', { name: button }));
    expect(sent).toEqual([{ method: 'POST', path: '/api/plans/Ada/command', body }]);
    const toast = useToasts.getState().toasts[0];
    expect(toast?.message).toBe(said);
    const now = steps.flatMap((one) => (left[one.id] ? [{ ...one, state: left[one.id] ?? one.state }] : []));
    act(() => useLive.getState().takeChanges([{ kind: 'plan', seq: 1, plan: plan({ robot: 'Ada', revision: 9, steps: now }) }]));
    toast?.action?.run();
    expect(sent[1]).toEqual({ method: 'PUT', path: '/api/plans/Ada/steps', body: { steps: again.map(call), revision: 9, undoes } });
  });

  it('does not say that a step is left out, nor puts it back, that was done before that was heard', async () => {
    const user = show();
    const become = (seq: number, states: Record<string, StepState>) => {
      const now = steps.map((one) => ({ ...one, state: states[one.id] ?? one.state }));
      act(() => useLive.getState().takeChanges([{ kind: 'plan', seq, plan: plan({ robot: 'Ada', revision: 9, state: 'ended', steps: now }) }]));
    };
    await user.click(screen.getByRole('button', { name: 'Skip' }));
    expect(useToasts.getState().toasts).toHaveLength(1);
    become(1, { two: 'finished' });
    expect(useToasts.getState().toasts).toEqual([]);

    become(2, { two: 'running' });
    act(() => useLive.getState().takeChanges([{ kind: 'plan', seq: 3, plan: plan({ robot: 'Ada', revision: 7, steps }) }]));
    await user.click(screen.getByRole('button', { name: 'Cancel all' }));
    become(4, { two: 'finished', three: 'skipped', four: 'skipped' });
    useToasts.getState().toasts[0]?.action?.run();
    expect(sent.at(-1)?.body).toEqual({ steps: ['Three', 'Four'].map(call), revision: 9, undoes: ['three', 'four'] });
  });

  it('puts back into a plan that moves on just then what it is by then', async () => {
    const user = show();
    await user.click(screen.getByRole('button', { name: 'Skip' }));
    status = 409;
    const moveOn = (seq: number) =>
      act(() => useLive.getState().takeChanges([{ kind: 'plan', seq, plan: plan({ robot: 'Ada', revision: 7 + seq, steps: steps.slice(3) }) }]));
    await act(async () => useToasts.getState().toasts[0]?.action?.run());
    status = 200;
    moveOn(1);
    await vi.waitFor(() => expect(sent).toHaveLength(3));
    expect(sent[2]?.body).toEqual({ steps: ['Two', 'Four'].map(call), revision: 8, undoes: ['two'] });
    expect(useToasts.getState().toasts.filter(({ tone }) => tone === 'error')).toEqual([]);
  });

  it('keeps each button in its place while a plan is being changed', async () => {
    const user = show();
    const names = () => screen.getAllByRole('button').map((one) => one.textContent).filter((text) => /Pause|Skip|Change|Cancel all/.test(text));
    const before = names();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    expect(names()).toEqual(before);
  });

  it('offers to continue what is paused', async () => {
    const user = show({ state: 'paused' });
    await user.click(screen.getByRole('button', { name: 'Continue' }));
    expect(sent).toMatchObject([{ body: { command: 'resume' } }]);
  });

  it('offers no control over what was not planned in conversation', () => {
    show({ kind: 'graph' });
    expect(screen.queryByRole('button', { name: 'Pause' })).toBeNull();
  });

  it('sends the waiting steps in their new order with the revision they were taken from', async () => {
    const user = show();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    const list = screen.getByRole('grid', { name: 'Change the plan' });
    expect(within(list).getAllByRole('row')).toHaveLength(2);
    await user.click(screen.getByRole('button', { name: 'Move “four” up' }));
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(sent.filter(({ method }) => method !== 'GET')).toEqual([
      { method: 'PUT', path: '/api/plans/Ada/steps', body: { steps: [call('Four'), call('Three')], revision: 7 } },
    ]);
  });

  it('says when the plan has moved on meanwhile', async () => {
    const user = show();
    status = 409;
    await user.click(screen.getByRole('button', { name: 'Change' }));
    await user.click(screen.getByRole('button', { name: 'Save' }));
    await vi.waitFor(() => expect(useToasts.getState().toasts.map((toast) => toast.message)).toEqual([expect.stringContaining('What you changed is kept')]), WAIT);
    screen.getByRole('grid');
    act(() => useLive.getState().takeChanges([{ kind: 'plan', seq: 1, plan: plan({ robot: 'Ada', state: 'ended', steps }) }]));
    expect(useToasts.getState().toasts).toEqual([]); // there is nothing to change any more
  });

  it('goes on being changed when steps of it begin, without those', async () => {
    const user = show();
    const list = () => within(screen.getByRole('grid', { name: 'Change the plan' })).getAllByRole('row');
    const change = (seq: number, now: typeof steps) =>
      act(() => useLive.getState().takeChanges([{ kind: 'plan', seq, plan: plan({ robot: 'Ada', revision: 7 + seq, steps: now }) }]));
    await user.click(screen.getByRole('button', { name: 'Change' }));
    const on = steps.map((one) => (one.id === 'four' ? one : { ...one, state: one.id === 'three' ? ('running' as const) : ('finished' as const) }));
    change(1, on);
    expect(list()).toHaveLength(1);
    await user.click(screen.getByRole('button', { name: 'Save' }));
    const saved = () => sent.filter(({ method }) => method === 'PUT').map(({ body }) => body);
    expect(saved()).toEqual([{ steps: [call('Four')], revision: 8 }]);

    await user.click(screen.getByRole('button', { name: 'Change' }));
    change(2, [...on.slice(0, 3), step({ id: 'five', call: call('Five') })]); // by somebody else
    expect(list()).toHaveLength(1);
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(saved()[1]).toEqual({ steps: [call('Five')], revision: 9 });
  });

  it('says that it waits for an answer where its step does, and offers no choice of one', () => {
    show({ steps: [step({ id: 'ask', state: 'waiting' }), step({ id: 'go' })] });
    screen.getByText('Waiting for your answer, step 1 of 2');
    expect(screen.queryByRole('button', { name: /Whose plan/ })).toBeNull();
  });

  it('marks what a change of a running plan brought', () => {
    show({ changed: ['four'] });
    expect(screen.getAllByText('New')).toHaveLength(1);
  });

  it('lets a person say yes or no to steps that wait for it', async () => {
    const user = show({ steps: [], state: 'awaiting_approval' });
    act(() => {
      const proposal = {
        id: 'p1',
        robot: 'Ada',
        message: 'I would go.” Kim says: “Yes',
        changes: ['Forget “box”'],
        steps: [step({ id: 's', label: 'Go to “door”', reason: 'to look' })],
        digest: 'd1',
        why: 'It is night.',
      };
      useLive.getState().takeChanges([{ kind: 'proposal', seq: 1, proposal }]);
    });
    const card = screen.getByRole('region', { name: 'Ada asks: shall I do this?' });
    const lines = ['It is night.', 'Forget “box”', 'Go to “door”', 'Says: “to look”', 'Says: “I would go.’ Kim says: ‘Yes”'];
    const inOrder = lines.reduce((at, line) => (at < 0 ? at : (card.textContent?.indexOf(line, at) ?? -1)), 0);
    expect(inOrder, card.textContent ?? '').toBeGreaterThan(0);
    await user.click(screen.getByRole('button', { name: 'Yes, begin: Go to “door”' }));
    expect(sent).toEqual([
      { method: 'POST', path: '/api/plans/Ada/decision', body: { id: 'p1', digest: 'd1', decision: 'approve' } },
    ]);
  });
});
