import { act, render, waitFor } from '@testing-library/react';
import { expect, it, vi } from 'vitest';

import { entry, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';
import { useTour } from '@/state/tour';

import { Tour } from './tour';

const sent: string[] = [];

it('goes on with a story only when what it led to was said yes or no to', async () => {
  vi.stubGlobal('fetch', (path: string) => {
    sent.push(path);
    return Promise.resolve(new Response('{}'));
  });
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
  render(<Tour robot="Ada" asks={false} />);
  act(() => useTour.getState().begin(['go to the door', 'go to the box']));
  await waitFor(() => expect(sent.length).toBe(1));
  const proposal = { id: 'p1', robot: 'Ada', message: '', changes: [], steps: [step({ id: 'a', label: 'go to the door' })], digest: 'd1', why: '' };
  const reply = entry({ id: 'r', seq: 7, who: 'robot', targets: ['Ada'], message: 'Shall I?' });
  act(() => useLive.getState().takeChanges([{ kind: 'proposal', seq: 1, proposal }, { kind: 'chat', seq: 2, entry: reply }]));
  expect(useTour.getState().at).toBe(0);
  act(() => useLive.getState().takeChanges([{ kind: 'proposal_gone', seq: 3, id: 'p1' }]));
  expect(useTour.getState().at).toBe(1);
  act(() => useTour.getState().end());
});
