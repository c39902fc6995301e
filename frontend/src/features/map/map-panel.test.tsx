import { act, fireEvent, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Answer, type Answers, type Asked } from '@/gallery/network';
import { entry, mapInfo, mapView, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import { useDrafts } from '@/state/drafts';
import { useOutbox } from '@/state/outbox';

import { MapPanel } from './map-panel';

const said = () => useOutbox.getState().messages.map(({ text, targets }) => ({ text, targets }));
const verdict = (part: object) => ({ forbidden: [], ask: [], risky: [], unknown: [], way: [], length_m: 0, expected_s: 0, ...part });
const draft = () => Object.values(useDrafts.getState().drafts)[0]?.text;

beforeEach(() => {
  useDrafts.setState({ drafts: {} });
  useOutbox.setState({ messages: [] });
  useLive.getState().setConnection('connected');
  vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
  const robots = [robot({ name: 'Ada' }), robot({ name: 'Bob', pose: { x: 5, y: 3, yaw: 0 }, map_name: 'hall' })];
  useLive.getState().takeSnapshot(snapshot({ robots, views: [mapView] }));
});

const show = async () => {
  render(<MapPanel />);
  const user = userEvent.setup();
  await user.click(await screen.findByRole('button', { name: 'List' }));
  return user;
};

describe('the map', () => {
  it.each([
    ['Pick Red box', 'Ada: Go to the red box', 'Go to the red box.'],
    ['Pick Hall', 'Ada: Go to the hall', 'Go to the hall.'],
  ])('says the way to what is picked as a message of this person: %s', async (pick, deed, text) => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: pick }));
    await user.click(screen.getByRole('button', { name: deed }));
    expect(said()).toEqual([{ text, targets: ['Ada'] }]);
  });

  it('refuses at once a place to which no way leads, and says how far others are', async () => {
    const answers: Record<string, Answer> = { map: { json: mapInfo }, 'rules/try': { json: verdict({ length_m: 0 }) } };
    vi.stubGlobal('fetch', network(answers));
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView] }));
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await screen.findByText('Ada cannot get there: no way leads there.');
    expect(screen.queryByRole('button', { name: /Go to/ })).toBeNull();
    answers['rules/try'] = { json: verdict({ length_m: 3.21, expected_s: 7.5, way: [[1, 2], [3, 1]] }) };
    await user.click(screen.getByRole('button', { name: 'Pick Front door' }));
    await screen.findByText('3.2 m, about 8 s');
    screen.getByRole('button', { name: 'Go to the front door' });
  });

  it('writes no name over the end of a way', async () => {
    render(<MapPanel />);
    const name = () => document.querySelector('text[data-of="room"]')?.getAttribute('y');
    await vi.waitFor(() => expect(name()).toBeDefined());
    const goesTo = (path: [number, number][]) =>
      act(() => useLive.getState().takeView({ ...mapView, path, goal: { x: 3, y: 2.5, yaw: 0 } }));
    goesTo([]);
    const before = name();
    goesTo([[3, 2.5]]);
    expect(name()).toBeDefined();
    expect(name()).not.toBe(before);
  });

  it('draws the way that waits for a yes', async () => {
    const answers: Answers = { map: { json: mapInfo }, 'rules/try': { json: verdict({ length_m: 2, way: [[1, 2], [3, 1]], goals: [[2, 2], [3, 1]] }) } };
    vi.stubGlobal('fetch', network(answers));
    const proposal = { id: 'p', robot: 'Ada', message: '', changes: [], steps: [step({ id: 's' })], digest: 'd', why: '' };
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView], proposals: [proposal] }));
    const { container } = render(<MapPanel />);
    await vi.waitFor(() => expect(container.querySelector('.tried polyline')?.getAttribute('points')).toBe('1,2 3,1'));
    expect(container.querySelectorAll('.tried circle').length).toBe(2); // where each step ends
  });

  it('draws what waits for a yes from where the plan that runs will end', async () => {
    const asked: Asked[] = [];
    vi.stubGlobal('fetch', network({ map: { json: mapInfo }, 'rules/try': { json: verdict({ length_m: 2, way: [[1, 2], [3, 1]] }) } }, asked));
    const proposal = { id: 'p', robot: 'Ada', message: '', changes: [], steps: [step({ id: 's', call: { name: 'second' } })], digest: 'd', why: '' };
    const steps = [step({ id: 'a', state: 'skipped', call: { name: 'left out' } }), step({ id: 'b', state: 'finished', call: { name: 'find' } }), step({ id: 'c', state: 'running', call: { name: 'first' } })];
    const runs = plan({ robot: 'Ada', state: 'running', steps });
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView], plans: [runs], proposals: [proposal] }));
    render(<MapPanel />);
    const tried = () => asked.filter(({ path }) => path === 'rules/try').map(({ body }) => body);
    await vi.waitFor(() => expect(tried()).toMatchObject([{ after: [{ name: 'find' }, { name: 'first' }], steps: [{ name: 'second' }] }]));
  });

  it('answers which one is meant by a tap on it', async () => {
    const question = entry({ id: 'q', type: 'request', question: 'open', message: 'Which?', choices: ['Blue box', 'Red box'] });
    useLive.getState().takeChanges([{ kind: 'chat', seq: 1, entry: question }]);
    const user = await show();
    screen.getByText(/^2/);
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await user.click(screen.getByRole('button', { name: 'Answer: Red box' }));
    expect(useOutbox.getState().messages).toMatchObject([{ text: 'Red box', targets: ['Ada'], reply_to: 'q' }]);
  });

  it('mentions a thing behind what is written already', async () => {
    useDrafts.getState().set('Ada', { text: 'Look at' });
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Pick Front door' }));
    await user.click(screen.getByRole('button', { name: 'Mention' }));
    expect(draft()).toBe('Look at the front door');
  });

  it('picks a bare place by the keyboard', async () => {
    const user = await show();
    const map = screen.getByRole('application');
    fireEvent.keyDown(map, { key: 'ArrowUp' });
    fireEvent.keyDown(map, { key: 'Enter' });
    fireEvent.keyDown(map, { key: 'Enter' }); // the room first, then the very place
    await user.click(screen.getByRole('button', { name: 'Ada: Go there' }));
    expect(said()).toEqual([{ text: 'Go to the point (3.00, 2.54).', targets: ['Ada'] }]);
  });

  it('makes a rule of an area drawn by keys, which holds after a yes', async () => {
    const asked: Asked[] = [];
    vi.stubGlobal('fetch', network({ map: { json: mapInfo }, 'rules/words?language=en': { json: { text: 'Stays out of it.' } } }, asked));
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView] }));
    render(<MapPanel />);
    const user = userEvent.setup();
    await user.click(await screen.findByRole('button', { name: 'Draw an area for a rule' }));
    const map = screen.getByRole('application');
    for (const key of ['Enter', 'ArrowUp', 'ArrowRight', 'Enter']) fireEvent.keyDown(map, { key });
    await screen.findByText('It becomes this rule: Stays out of it. It holds only after your yes.');
    expect(asked.some(({ method }) => method === 'PUT')).toBe(false);
    await user.click(screen.getByRole('button', { name: 'Let it hold' }));
    expect(asked.find(({ method }) => method === 'PUT')).toMatchObject({
      path: 'rules/keep-out-part-of-the-hall?language=en',
      body: { kind: 'keep_out', name: 'part of the hall', map: 'hall', rectangle: [3, 1.5, 4.04, 2.54] },
    });
  });

  it('writes on an area what its rule calls it, and not once more on a room that is closed', async () => {
    const zone = { kind: 'keep_out', map: 'hall', robots: [], exempt: [], rectangle: [1, 1, 3, 2] };
    const rules = ['Wet floor', 'Hall'].map((name) => ({ rule: { ...zone, id: name, name }, text: name, holds: true }));
    vi.stubGlobal('fetch', network({ map: { json: mapInfo }, 'rules?language=en': { json: { rules } } }));
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView] }));
    render(<MapPanel />);
    await screen.findByText('Wet floor');
    expect(document.querySelectorAll('text[data-of="zone"]')).toHaveLength(1);
  });

  it('writes what is closed where the name of its room would stand, and that elsewhere in the room', async () => {
    const zone = { kind: 'keep_out', map: 'hall', robots: [], exempt: [], id: 'wet', name: 'Wet floor', rectangle: [2.8, 2, 3.4, 2.4] };
    const rules = [{ rule: zone, text: '', holds: true }];
    vi.stubGlobal('fetch', network({ map: { json: mapInfo }, 'rules?language=en': { json: { rules } } }));
    useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { rules: true } }, robots: [robot({ name: 'Ada' })], views: [mapView] }));
    render(<MapPanel />);
    await screen.findByText('Wet floor');
    expect(document.querySelectorAll('text[data-of="room"]')).toHaveLength(1);
  });

  it('says in words where each robot of the same map is', async () => {
    await show();
    const list = within(screen.getByRole('region', { name: 'The map as a list' }));
    expect(list.getByText('Ada').closest('li')?.textContent).toBe('Ada is near: front door. It is on its way.');
    expect(list.getByText('Bob')).toBeTruthy();
  });

  it('stays as it was seen last, with its age, while there is no connection', async () => {
    const { unmount } = render(<MapPanel />);
    await screen.findByRole('application');
    unmount();
    act(() => useLive.getState().setConnection('lost', Date.now() - 12_000));
    vi.stubGlobal('fetch', network({ map: { refused: 'gone' } }));
    render(<MapPanel />);
    expect(screen.getByRole('application')).toBeTruthy();
    expect(screen.getByText('Not connected. This is how it was 12 seconds ago.')).toBeTruthy();
    vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
    act(() => useLive.getState().setConnection('connected'));
    await vi.waitFor(() => expect(screen.queryByText(/^Not connected/)).toBeNull());
  });

  it('says that it is connecting where none was seen yet, and shows it once there is a connection', async () => {
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Cay' })] }));
    useLive.getState().setConnection('lost', 1);
    render(<MapPanel />);
    expect(screen.getByText('Not connected. Trying again…')).toBeTruthy();
    act(() => useLive.getState().setConnection('connected'));
    expect(await screen.findByRole('application')).toBeTruthy();
  });
});
