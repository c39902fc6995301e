import { act, render } from '@testing-library/react';
import { expect, it } from 'vitest';

import { entry, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';

import { History } from './history';

it('shows what asks for a yes as the question it is, as long as it waits', () => {
  const said = entry({ id: 'w', seq: 1, message: 'I would go. Shall I?', asks_yes: true });
  const proposal = { id: 'p', robot: 'Ada', message: '', changes: [], steps: [step({ id: 's' })], digest: 'd', why: '' };
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], chat: [said], proposals: [proposal] }));
  render(<History entries={[said]} asked={[]} onChoose={() => undefined} onEdit={() => undefined} empty={null} />);
  const bubble = () => document.querySelector('[data-entry="w"]')?.getAttribute('data-question');
  expect(bubble()).toBe('open');
  act(() => useLive.getState().takeChanges([{ kind: 'proposal_gone', seq: 1, id: 'p' }]));
  expect(bubble()).toBeNull();
});
