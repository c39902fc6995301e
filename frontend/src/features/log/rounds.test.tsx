import { fireEvent, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { robot, round, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useDrafts } from '@/state/drafts';

import { HistoryPage } from './history-page';

let asked: Asked[];
const lost = round({ number: 5, words: 'look at the door', state: 'unrecorded' });
const looked = round({ number: 7, words: 'look at the box', state: 'failed', reason: 'It is hidden.', found: ['I can see a bag.'], pictures: ['/api/chat/images/a'] });

beforeEach(() => {
  asked = [];
  const handover = { since_unix_ms: 1, until_unix_ms: 2, rounds: [looked, lost, round({ number: 9, state: 'partly', left: ['Look at the bed'] })], waits: [], stops: [[1, 'Kim stopped Ada.']], rules: [] };
  const answers = { history: { json: { rounds: [round({ number: 9 }), looked], complete: false } }, 'history/handover': { json: handover } };
  vi.stubGlobal('fetch', network(answers, asked));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
});

const wish = () => new URLSearchParams(asked.at(-1)?.path.split('?')[1]);

it('shows what robots did with what they saw, and takes an order up again without sending it', async () => {
  const user = userEvent.setup();
  render(<HistoryPage />);
  await screen.findByText('It is hidden.');
  screen.getByText('Found: I can see a bag.');
  screen.getByRole('img', { name: 'Picture 1 of “Look at the box”' });
  expect(screen.getByRole('link', { name: /pictures: Look at the box/ }).getAttribute('href')).toBe('/api/history/file?number=7&language=en');
  await user.type(screen.getByLabelText('Search'), 'box');
  await user.click(screen.getByRole('button', { name: 'Older' }));
  expect([wish().get('q'), wish().get('before'), Number(wish().get('since')) > 0]).toEqual(['box', '7', true]);
  fireEvent.click(screen.getByRole('button', { name: 'Do again: go to the box' }));
  expect(useDrafts.getState().drafts).toEqual({ Ada: { text: 'go to the box', photo: null } });
});

it('tells how long the robot worked, not how long people let it wait, and nothing where that is not known', async () => {
  const rounds = [round({ number: 9 }), round({ number: 8, worked_ms: null })];
  vi.stubGlobal('fetch', network({ history: { json: { rounds, complete: true } } }, asked));
  render(<HistoryPage />);
  const shown = await screen.findAllByText('Kim (phone) to Ada');
  expect(shown.map((by) => by.previousElementSibling?.textContent?.trim())).toEqual(['worked 0:32', 'Done']);
});

it('never says that nothing was done yet where it only shows a part of the time', async () => {
  const user = userEvent.setup();
  vi.stubGlobal('fetch', network({ history: { json: { rounds: [], complete: true } } }, asked));
  render(<HistoryPage />);
  await screen.findByText('Today: nothing was done.');
  await user.click(screen.getByRole('button', { name: /Today/ }));
  await user.click(screen.getByRole('option', { name: 'All' }));
  await screen.findByText('No robot has done anything yet.');
});

it('tells the next shift what failed, apart from what was done, and who stopped what', async () => {
  const user = userEvent.setup();
  render(<HistoryPage />);
  await user.click(screen.getByRole('button', { name: 'Handover' }));
  const part = (name: string) => within(screen.getByRole('heading', { name }).closest('section') ?? document.body);
  await screen.findByRole('article');
  part('Did not work, was ended early, or its end was not recorded').getByText(/Look at the box – Did not work – .*It is hidden\./);
  part('Did not work, was ended early, or its end was not recorded').getByText('Found: I can see a bag.');
  part('Did not work, was ended early, or its end was not recorded').getByText(/Look at the door – (Ended early|End not recorded)/);
  part('Done').getByText(/Kim \(phone\) to Ada: Go to the box – Done in part – Left out: Look at the bed/);
  part('Stops').getByText(/Kim stopped Ada\./);
  part('Waits for somebody').getByText('Nothing.');
});
