import { fireEvent, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Answers, type Asked } from '@/gallery/network';
import { mapInfo, mapView, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useToasts } from '@/state/toasts';

import { MapPanel } from './map-panel';
import { drawn, newDraft, putOf } from './place-draft';
import { useEdits } from './place-edits';

const changed = (part: object = {}) => ({ json: { put: null, same: [], notes: [], problem: '', ...part } });
const asked: Asked[] = [];
const changes = () => asked.filter(({ method, body }) => method === 'POST' && !(body as { only_try: boolean }).only_try).map(({ body }) => body);

const show = async (answers: Answers) => {
  vi.stubGlobal('fetch', network({ map: { json: mapInfo }, 'map/Ada/places': changed(), ...answers }, asked));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], views: [mapView] }));
  render(<MapPanel />);
  const user = userEvent.setup();
  await user.click(await screen.findByRole('button', { name: 'Rooms and things' }));
  return user;
};

const press = (...keys: string[]) => {
  for (const key of keys) fireEvent.keyDown(screen.getByRole('application'), { key });
};

beforeEach(() => {
  asked.length = 0;
  useEdits.setState({ done: [], count: 0 });
  useToasts.setState({ toasts: [] });
  useLive.getState().setConnection('connected');
});

describe('rooms and things', () => {
  it('says what to do on a map without any names', async () => {
    await show({ map: { json: { ...mapInfo, objects: [], rooms: [] } } });
    await screen.findByText(/^This map has no names yet/);
  });

  it('puts a room drawn by keys on the map, and takes it back', async () => {
    const room = { name: 'lab', corners: [[3, 1.5], [4.04, 1.5], [4.04, 2.54], [3, 2.54]] };
    const user = await show({ 'map/Ada/places': changed({ put: room, notes: ['Ada finds no free spot there.'] }) });
    await user.click(await screen.findByRole('button', { name: 'Draw a room' }));
    press('Enter', 'ArrowUp', 'ArrowRight', 'Enter');
    await user.type(screen.getByRole('textbox', { name: 'What people call it' }), 'lab');
    await screen.findByText('Ada finds no free spot there.');
    expect(changes()).toEqual([]);
    await user.click(screen.getByRole('button', { name: 'Put it on the map' }));
    expect(changes()).toMatchObject([{ was: null, put: room, anyway: false }]);
    await user.click(await screen.findByRole('button', { name: 'Undo' }));
    expect(changes()[1]).toMatchObject({ was: room, put: null });
  });

  it('asks which is meant when a name is there already', async () => {
    const same = { ...mapInfo.objects[0], stand: null };
    const user = await show({ 'map/Ada/places': changed({ same: [same] }) });
    await user.click(await screen.findByRole('button', { name: 'Put a thing' }));
    press('Enter');
    await user.type(screen.getByRole('textbox', { name: 'What people call it' }), 'red box');
    await screen.findByText('“red box” is on the map already. Which do you mean?');
    expect(screen.queryByRole('button', { name: 'Put it on the map' })).toBeNull();
    await user.click(screen.getByRole('button', { name: 'Move that one here' }));
    await user.click(screen.getByRole('button', { name: 'Have two of that name' }));
    expect(changes()).toMatchObject([
      { was: same, put: { id: 'box_1', x: 3, y: 1.5 }, anyway: true },
      { was: null, put: { id: '', description: 'red box', x: 3, y: 1.5 }, anyway: true },
    ]);
  });

  it('renames what is picked out and takes it off', async () => {
    const user = await show({ 'map/Ada/places': changed({ put: mapInfo.objects[0] }) });
    await user.click(screen.getByRole('button', { name: 'List' }));
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await user.click(screen.getByRole('button', { name: 'Rename or move' }));
    const box = screen.getByRole('textbox', { name: 'What people call it' });
    await user.clear(box);
    await user.type(box, 'tea trolley');
    await user.click(screen.getByRole('button', { name: 'Put it on the map' }));
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await user.click(screen.getByRole('button', { name: 'Take off the map' }));
    expect(changes()).toMatchObject([
      { was: { id: 'box_1', description: 'red box' }, put: { id: 'box_1', description: 'tea trolley', x: 3, y: 1 } },
      { was: { id: 'box_1' }, put: null },
    ]);
  });

  it('tells who comes second', async () => {
    const user = await show({ 'map/Ada/places': { refused: 'Somebody else changed that meanwhile.' } });
    await user.click(screen.getByRole('button', { name: 'List' }));
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await user.click(screen.getByRole('button', { name: 'Take off the map' }));
    expect(useToasts.getState().toasts[0]?.message).toMatch(/^Somebody else changed that meanwhile\./);
  });

  it('offers what a robot saw', async () => {
    const seen = { ...mapInfo.objects[0], id: 't', description: 'trolley', found: true };
    const user = await show({ map: { json: { ...mapInfo, objects: [seen] } }, 'map/Ada/places': changed() });
    await user.click(await screen.findByRole('button', { name: 'Put it on the map' }));
    await user.click(screen.getByRole('button', { name: 'It is not there' }));
    expect(changes()).toMatchObject([{ was: { id: 't', found: true }, put: { id: 't', found: false } }, { was: { id: 't' }, put: null }]);
  });

  it('has a robot stand where it was drawn to, looking at the thing', () => {
    const draft = drawn(drawn({ ...newDraft('thing'), name: 'pump' }, [[1, 2]]), [[1, 2], [1, 1]]);
    expect(putOf(draft)).toMatchObject({ description: 'pump', x: 1, y: 2, stand: { x: 1, y: 1, yaw: Math.PI / 2 } });
  });
});
