import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it, vi } from 'vitest';

import { entry, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import type { ChatEntry } from '@/live/types';

import { Asks } from './asks';

vi.mock('./use-in-sight', () => ({ useInSight: () => true }));

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

it('lets go by a tap of what is answered in words, where a reply asks', async () => {
  const chosen = vi.fn();
  const asked = (part: Partial<ChatEntry>) => [entry({ id: 'q', seq: 1, message: 'Where to?', question: 'open', ...part })];
  const { rerender } = render(<Asks chosen={['Ada']} asked={asked({ type: 'response' })} onChoose={chosen} />);
  await userEvent.setup().click(screen.getByRole('button', { name: 'Never mind' }));
  expect(chosen.mock.lastCall?.[1]).toBe('never mind');
  rerender(<Asks chosen={['Ada']} asked={asked({ type: 'request' })} onChoose={chosen} />);
  expect(screen.queryByRole('button')).toBeNull();
});
