import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it, vi } from 'vitest';

import { entry, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import type { ChatEntry } from '@/live/types';

import { Asks } from './asks';

vi.mock('./use-in-sight', () => ({ useInSight: (id: string) => id !== '' }));

it('says whose question it is where several are talked to, and does not say again what is read already', () => {
  const question = entry({ id: 'q', seq: 1, type: 'request', targets: ['Bob'], message: 'Which box?', question: 'open', choices: ['red', 'blue'] });
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), robot({ name: 'Bob' })], chat: [question] }));
  const asks = (chosen: readonly string[]) => <Asks chosen={chosen} asked={[question]} onChoose={() => undefined} />;
  const { rerender } = render(asks(['Bob']));
  expect(screen.getByText('Which box?').className).toBe('hidden');
  rerender(asks(['Ada', 'Bob']));
  expect(screen.getByText('Which box?').className).not.toBe('hidden');
  screen.getByText('Bob asks:');
});

it('says what waits for a yes once where that is read already', () => {
  const said = entry({ id: 'w', seq: 1, targets: ['Ada'], message: 'I would go to the box. Shall I?', asks_yes: true });
  const proposal = { id: 'p', robot: 'Ada', message: '', changes: [], steps: [step({ id: 's', label: 'go to the box' })], digest: 'd', why: '' };
  const take = (chat: ChatEntry[]) => useLive.getState().takeSnapshot(snapshot({ run: 'again', robots: [robot({ name: 'Ada' })], chat, proposals: [proposal] }));
  const asks = () => <Asks chosen={['Ada']} asked={[]} onChoose={() => undefined} />;
  take([said]);
  const { unmount } = render(asks());
  expect(screen.getByText('Go to the box').className).toBe('hidden');
  unmount();
  take([{ ...said, asks_yes: false }]);
  render(asks());
  expect(screen.getByText('Go to the box').className).not.toBe('hidden');
});

it('lets go by a tap of what is answered in words, where a reply asks', async () => {
  const chosen = vi.fn();
  const asked = (part: Partial<ChatEntry>) => [entry({ id: 'q', seq: 1, message: 'Where to?', question: 'open', ...part })];
  const { rerender } = render(<Asks chosen={['Ada']} asked={asked({ type: 'response' })} onChoose={chosen} />);
  await userEvent.setup().click(screen.getByRole('button', { name: 'Never mind' }));
  expect(chosen.mock.lastCall?.[1]).toBe('never mind');
  rerender(<Asks chosen={['Ada']} asked={asked({ type: 'request' })} onChoose={chosen} />);
  expect(screen.queryByRole('button')).toBeNull();
});
