import { act, cleanup, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Answer, type Asked } from '@/gallery/network';
import { ability, mapInfo, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import type { PlanView, ProposalView, StepView } from '@/live/types';

import { useToasts } from '@/state/toasts';
import * as words from '@/ui/words';

import { useKeptEdits } from './lasting';
import { PlanPanel } from './plan-panel';

const call = (name: string) => ({ [name]: { input_parameters: {}, output_parameters: {} } });
const named = (...names: string[]) => names.map((name) => step({ id: name, planned: name, label: name, action: name, call: call(name) }));

vi.setConfig({ testTimeout: 20_000 });

describe('a plan that is being changed', () => {
  const asked: Asked[] = [];
  const answers: Record<string, Answer> = {};
  const told = (plans: readonly PlanView[], proposals: readonly ProposalView[] = []) =>
    act(() => useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], plans: [...plans], proposals: [...proposals] })));
  const names = () => within(screen.getByRole('grid')).getAllByRole('row').map((row) => row.textContent?.match(/One|Two|Three|Four/)?.[0]);
  const puts = () => asked.filter(({ method }) => method !== 'GET').map(({ body }) => body);

  beforeEach(() => {
    asked.length = 0;
    Object.assign(answers, { 'robots/Ada/map': { json: mapInfo }, 'map': { json: mapInfo }, 'plans/Ada/steps': { json: {} }, 'plans/Ada/decision': { json: {} } });
    vi.stubGlobal('fetch', network(answers, asked));
    useKeptEdits.setState({}, true);
    useToasts.setState({ toasts: [] });
  });

  it('stays as far as one got over a restart and on other pages, and drops nothing that waits again', async () => {
    const [one, ...rest] = named('One', 'Two', 'Three', 'Four');
    if (!one) throw new Error('there are four');
    told([plan({ robot: 'Ada', revision: 4, state: 'paused', steps: [{ ...one, state: 'paused' }, ...rest] })]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    await user.click(screen.getByRole('button', { name: 'Remove “Three”' }));
    act(() => useLive.getState().takeSnapshot(snapshot())); // the server was killed, and nobody has told it yet what there is
    expect(screen.queryByRole('grid')).toBeNull();
    cleanup();
    told([plan({ robot: 'Ada', revision: 1009, state: 'paused', steps: [one, ...rest].map((each) => ({ ...each, planned: `new ${each.id}` })) })]);
    render(<PlanPanel />);
    expect(names()).toEqual(['Two', 'Four']);
    screen.getByRole('button', { name: /^1\. One/ });
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(puts()).toEqual([{ steps: ['One', 'Two', 'Four'].map(call), revision: 1009 }]);
    expect(screen.queryByRole('grid')).toBeNull();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    expect(names()).toEqual(['One', 'Two', 'Three', 'Four']);
  });

  it('is said to be over as soon as somebody else has given it up, and then for nobody to change', async () => {
    const steps = named('One', 'Two');
    told([plan({ robot: 'Ada', revision: 4, state: 'paused', steps })]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    await user.click(screen.getByRole('button', { name: 'Remove “Two”' }));
    expect(screen.queryByText(/there is nothing to change any more/)).toBeNull();
    told([plan({ robot: 'Ada', revision: 5, state: 'idle', steps: [] })]);
    screen.getByText(/there is nothing to change any more/);
    answers['plans/Ada/steps'] = { refused: 'The plan has changed meanwhile.', status: 409 };
    await user.click(screen.getByRole('button', { name: 'Save' }));
    await vi.waitFor(() => expect(screen.queryByRole('grid')).toBeNull());
    expect(useToasts.getState().toasts.map(({ message }) => message)).toEqual([expect.stringMatching(/there is nothing to change any more/)]);
    screen.getByText('Ada has nothing to do.');
  });

  it('is not drawn anew whenever the robot drives on: a long one could not be changed for that', async () => {
    const [one, ...rest] = named('One', 'Two', 'Three');
    if (!one) throw new Error('there are three');
    const drives = (progress: number, unixMs = 0) => {
      const robots = [robot({ name: 'Ada', last_seen_unix_ms: unixMs, catalogue: [ability({ name: 'Go' })] })];
      const plans = [plan({ robot: 'Ada', state: 'running', steps: [{ ...one, state: 'running', progress }, ...rest] })];
      act(() => useLive.getState().takeSnapshot(snapshot({ robots, plans })));
    };
    drives(0);
    render(<PlanPanel />);
    await userEvent.setup().click(screen.getByRole('button', { name: 'Change' }));
    const drawn = vi.spyOn(words, 'quoted'); // each row says with it what its buttons are about
    drives(0.5, 1);
    screen.getByRole('progressbar');
    expect(drawn).not.toHaveBeenCalled();
  });

  it('is agreed to as what it was when one began, not as what it has become meanwhile', async () => {
    const waits = (digest: string, ...steps: string[]): ProposalView => ({
      id: 'p', robot: 'Ada', message: '', changes: [], steps: named(...steps), digest, by: null, why: '',
    });
    const idle = plan({ robot: 'Ada', state: 'awaiting_approval', steps: [] });
    told([idle], [waits('first', 'One', 'Two')]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    told([idle], [waits('second', 'Three')]);
    expect(names()).toEqual(['One', 'Two']);
    await user.click(screen.getByRole('button', { name: 'Begin the changed plan' }));
    expect(puts()).toMatchObject([{ id: 'p', digest: 'first', decision: 'edit', steps: ['One', 'Two'].map(call) }]);
  });

  it('is kept when somebody else was faster, put into what they made of the plan, and saved with one more press', async () => {
    const [one, two, three, four] = named('One', 'Two', 'Three', 'Four') as [StepView, StepView, StepView, StepView];
    told([plan({ robot: 'Ada', revision: 4, state: 'running', steps: [one, two, three] })]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    await user.click(screen.getByRole('button', { name: 'Move “Three” up' }));
    answers['plans/Ada/steps'] = { refused: 'The plan has changed meanwhile.', status: 409 };
    await user.click(screen.getByRole('button', { name: 'Save' }));
    told([plan({ robot: 'Ada', revision: 5, state: 'running', steps: [two, four, three] })]); // heard after the no
    await vi.waitFor(() => expect(names()).toEqual(['Three', 'Two', 'Four']));
    answers['plans/Ada/steps'] = { json: {} };
    const write = document.body.appendChild(document.createElement('input'));
    write.focus();
    told([plan({ robot: 'Ada', revision: 6, state: 'running', steps: [two, four] })]); // and before one saves
    expect(names()).toEqual(['Two', 'Four']);
    expect(document.activeElement).toBe(write);
    told([plan({ robot: 'Ada', revision: 7, state: 'running', steps: [two, four, three] })]);
    expect(names()).toEqual(['Two', 'Four', 'Three']);
    told([plan({ robot: 'Ada', revision: 8, state: 'idle', steps: [] })]); // everything is cancelled, and begun again
    told([plan({ robot: 'Ada', revision: 9, state: 'running', steps: [two, four, three] })]);
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(puts().at(-1)).toEqual({ steps: ['Two', 'Four', 'Three'].map(call), revision: 9 });
    expect(screen.queryByRole('grid')).toBeNull();
  });

  it('is closed where there is nothing to change any more', async () => {
    told([plan({ robot: 'Ada', revision: 4, state: 'running', steps: named('One', 'Two') })]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    told([plan({ robot: 'Ada', revision: 5, state: 'idle', steps: [] })]);
    answers['plans/Ada/steps'] = { refused: 'Ada has no plan to change.', status: 409 };
    await user.click(screen.getByRole('button', { name: 'Save' }));
    await vi.waitFor(() => expect(screen.queryByRole('grid')).toBeNull(), { timeout: 10_000 });
  });

  it('is kept when somebody else says yes to it meanwhile, and given up when they say no', async () => {
    const waits: ProposalView = { id: 'p', robot: 'Ada', message: '', changes: [], steps: named('One', 'Two', 'Three'), digest: 'd', by: null, why: '' };
    const idle = plan({ robot: 'Ada', state: 'awaiting_approval', steps: [] });
    const user = userEvent.setup();
    render(<PlanPanel />);
    for (const isYes of [true, false]) {
      told([idle], [waits]);
      await user.click(screen.getByRole('button', { name: 'Change' }));
      await user.click(screen.getByRole('button', { name: 'Remove “Three”' }));
      const [one, ...rest] = named('One', 'Two', 'Three') as [StepView, ...StepView[]];
      act(() => useLive.getState().takeChanges([{ kind: 'proposal_gone', seq: 1, id: 'p' }]));
      if (isYes) told([plan({ robot: 'Ada', revision: 7, state: 'running', steps: [{ ...one, state: 'running' }, ...rest] })]);
      if (isYes) await vi.waitFor(() => expect(names()).toEqual(['Two']));
      else expect(screen.queryByRole('grid')).toBeNull();
      if (isYes) await user.click(screen.getByRole('button', { name: 'Cancel' }));
    }
  });

  it('is not said to be changed where what was changed had begun', async () => {
    const steps = named('One', 'Two', 'Three');
    const [one, two, three] = steps as [StepView, StepView, StepView];
    const waits: ProposalView = { id: 'p', robot: 'Ada', message: '', changes: [], steps, digest: 'd', by: null, why: '' };
    told([plan({ robot: 'Ada', state: 'awaiting_approval', steps: [] })], [waits]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    await user.click(screen.getByRole('button', { name: 'Move “Two” up' }));
    act(() => useLive.getState().takeChanges([{ kind: 'proposal_gone', seq: 1, id: 'p' }]));
    told([plan({ robot: 'Ada', revision: 7, state: 'running', steps: [{ ...one, state: 'running' }, two, three] })]);
    const notes = () => useToasts.getState().toasts.map(({ message }) => message.replace(/[,:].*/, ''));
    await vi.waitFor(() => expect(notes()).toEqual(['The plan changed meanwhile']));
    expect(useToasts.getState().toasts[0]?.message).toContain('nothing is left of what you changed');
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(notes()).toEqual([]); // nor "The plan was changed."
    expect(screen.queryByRole('grid')).toBeNull();
  });

  it.each(['One', 'anew'])('is not said to lack a step that somebody else has put back, as %s', async (planned) => {
    const [one, two] = named('One', 'Two') as [StepView, StepView];
    told([plan({ robot: 'Ada', revision: 4, state: 'running', steps: [{ ...one, state: 'running' }, two] })]);
    render(<PlanPanel />);
    const notes = () => useToasts.getState().toasts.map(({ message }) => message);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Skip' }));
    told([plan({ robot: 'Ada', revision: 5, state: 'running', steps: [{ ...one, state: 'skipped' }, { ...two, state: 'running' }] })]);
    expect(notes()).toEqual(['“One” is left out.']);
    told([plan({ robot: 'Ada', revision: 6, state: 'running', steps: [{ ...one, planned, state: 'running' }, two] })]);
    expect(notes()).toEqual([]);
  });

  it('keeps a step that has begun meanwhile, should it wait again, and takes nobody else for who saves', async () => {
    const [one, two, three, four] = named('One', 'Two', 'Three', 'Four') as [StepView, StepView, StepView, StepView];
    told([plan({ robot: 'Ada', revision: 4, state: 'running', steps: [{ ...one, state: 'running' }, two, three, four] })]);
    render(<PlanPanel />);
    const user = userEvent.setup();
    await user.click(screen.getByRole('button', { name: 'Change' }));
    told([plan({ robot: 'Ada', revision: 5, state: 'running', steps: [{ ...one, state: 'finished' }, { ...two, state: 'running' }, three, four] })]);
    await user.click(screen.getByRole('button', { name: 'Move “Four” up' }));
    expect(names()).toEqual(['Four', 'Three']);
    told([plan({ robot: 'Ada', revision: 1009, state: 'paused', steps: named('Two', 'Three', 'Four') })]); // a restart
    expect(names()).toEqual(['Two', 'Four', 'Three']);
    const saved = named('Two', 'Four', 'Three');
    vi.stubGlobal('fetch', (path: string, options: RequestInit) => {
      told([plan({ robot: 'Ada', revision: 1010, state: 'paused', steps: saved })]); // heard before the answer
      return network(answers, asked)(path, options);
    });
    await user.click(screen.getByRole('button', { name: 'Save' }));
    expect(puts().at(-1)).toEqual({ steps: ['Two', 'Four', 'Three'].map(call), revision: 1009 });
    expect(useToasts.getState().toasts.map(({ message }) => message)).toEqual(['The plan was changed.']);
    expect(screen.queryByRole('grid')).toBeNull();
  });
});
