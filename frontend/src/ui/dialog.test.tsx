import { act, render, screen } from '@testing-library/react';
import { useState } from 'react';
import { expect, it } from 'vitest';

import { Dialog } from './dialog';

function Box() {
  const [open, setOpen] = useState(true);
  return (
    <Dialog title="Keys" isOpen={open} onClose={() => setOpen(false)}>
      <p />
    </Dialog>
  );
}

it('is closed by going back, which leaves the page that it lay over', () => {
  render(<Box />);
  screen.getByRole('dialog');
  act(() => void window.dispatchEvent(new HashChangeEvent('hashchange')));
  expect(screen.queryByRole('dialog')).toBeNull();
});
