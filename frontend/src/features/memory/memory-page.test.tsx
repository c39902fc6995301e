import { act, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { memory, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useToasts } from '@/state/toasts';

import { MemoryPage } from './memory-page';
import { nameFor, sourceOf } from './remembering';

const asked: Asked[] = [];
const changes = () => asked.filter((one) => one.method !== 'GET');

beforeEach(() => {
  asked.length = 0;
  const items = [memory({ name: 'box_place' }), memory({ name: 'door', scope: 'Ada', data: 'The door is open.' }), memory({ name: 'bag_sighting', data: 'I saw the bag at the point (1.1, 2.2), by the desk.', told: 'I saw the bag, by the desk.' })];
  const before = [memory({ name: 'box_place', data: 'The box is in the hall.' })];
  vi.stubGlobal('fetch', network({ memory: { json: items }, 'memory/history?name=box_place&scope=': { json: before } }, asked));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
});

const show = async () => {
  render(<MemoryPage />);
  await screen.findByText('The box is by the door.');
  screen.getByText('I saw the bag, by the desk.');
  return userEvent.setup();
};

describe('the memory page', () => {
  it('forgets for one robot only what only it knew, and brings it back', async () => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Forget “Door”' }));
    await vi.waitFor(() => expect(changes()).toMatchObject([{ method: 'DELETE', path: 'memory?name=door&scope=Ada' }]));
    act(() => useToasts.getState().toasts[0]?.action?.run());
    await vi.waitFor(() =>
      expect(changes()[1]).toMatchObject({
        method: 'PUT',
        path: 'memory?name=door',
        body: { data: 'The door is open.', scope: 'Ada' },
      }),
    );
  });

  it('tells what was said, and in which words, from what nobody said', async () => {
    const items = [
      memory({ name: 'told', words: 'Put the box by the door please.' }),
      memory({ name: 'same', words: 'the box is by the door' }),
      memory({ name: 'guessed', source: 'Ada', way: 'concluded' }),
    ];
    vi.stubGlobal('fetch', network({ memory: { json: items } }, asked));
    render(<MemoryPage />);
    await screen.findByText('In the words “Put the box by the door please.”');
    expect(screen.getAllByText(/^In the words/)).toHaveLength(1);
    expect(screen.getByText('Concluded by the robot, nobody said it').parentElement?.textContent).not.toContain('From');
  });

  it('corrects what is remembered under its own name', async () => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Correct “Box place”' }));
    const box = screen.getByRole('textbox', { name: 'What should be remembered?' });
    await user.clear(box);
    await user.type(box, 'The box is gone.');
    await user.click(screen.getByRole('button', { name: 'Save' }));
    await vi.waitFor(() => expect(changes()).toMatchObject([{ path: 'memory?name=box_place', body: { data: 'The box is gone.' } }]));
  });

  it('adds something without asking for a name', async () => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Add' }));
    await user.type(screen.getByRole('textbox', { name: 'What should be remembered?' }), 'Kim likes tea.');
    await user.click(screen.getByRole('button', { name: 'Save' }));
    await vi.waitFor(() => expect(changes()).toMatchObject([{ path: 'memory?name=kim_likes_tea', body: { data: 'Kim likes tea.', scope: '' } }]));
  });

  it('shows what was there before, to be used again', async () => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'What “Box place” was before' }));
    await screen.findByText('The box is in the hall.');
    await user.click(screen.getByRole('button', { name: 'Use this again' }));
    await vi.waitFor(() => expect(changes()).toMatchObject([{ path: 'memory?name=box_place', body: { data: 'The box is in the hall.' } }]));
  });

  it('asks again when memories change elsewhere', async () => {
    await show();
    const before = asked.length;
    act(() => useLive.getState().takeChanges([{ kind: 'memory', seq: 1, event: 'added', name: 'x', message: '' }]));
    await vi.waitFor(() => expect(asked.length).toBeGreaterThan(before));
  });
});

describe('a memory', () => {
  it('is named by its first words', () => {
    expect(nameFor('The  Door, of "room" 7 is open now')).toBe('the_door_of_room_7_is');
    expect(nameFor('…')).toBe('');
  });

  it('says where it came from', () => {
    const from = (source: string) => sourceOf(memory({ name: 'x', source }));
    expect(from('')).toEqual({ kind: 'none' });
    expect(from('operator')).toEqual({ kind: 'operator' });
    expect(from('Kim')).toEqual({ kind: 'someone', who: 'Kim' });
    expect(from('Ada/Look')).toEqual({ kind: 'deed', who: 'Ada' });
  });
});
