import { render, screen } from '@testing-library/react';
import { expect, it, vi } from 'vitest';

import { entry, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

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
