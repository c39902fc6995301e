import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it } from 'vitest';

import { draftKey, useDrafts } from '@/state/drafts';
import { useOutbox } from '@/state/outbox';

import { PendingEntry } from './pending-entry';

it('offers to change what would be refused again, and takes its words up', async () => {
  const message = { id: 'm', text: 'the red one', targets: ['Ada'], reply_to: 'q', images: [], unixMs: 0, state: 'failed', reason: 'Settled.', refused: true } as const;
  useOutbox.setState({ messages: [message] });
  render(<PendingEntry message={message} />);
  expect(screen.queryByRole('button', { name: 'Send again' })).toBeNull();
  await userEvent.setup().click(screen.getByRole('button', { name: 'Change and send again' }));
  expect(useDrafts.getState().drafts[draftKey(['Ada'])]?.text).toBe('the red one');
  expect(useOutbox.getState().messages).toEqual([]);
});
