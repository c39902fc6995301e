import { act, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { useState } from 'react';
import { expect, it, vi } from 'vitest';

import { keepFocus } from './keep-focus';

function Part({ home }: { home: boolean }) {
  const [asked, setAsked] = useState(true);
  return (
    <section aria-label="part" tabIndex={-1}>
      {asked && (
        <div>
          <button type="button" onClick={() => setAsked(false)}>
            No
          </button>
        </div>
      )}
      {home && <textarea data-home />}
    </section>
  );
}

it.each([true, false])('stays in the part whose button went away (a place to write there: %s)', async (home) => {
  const end = keepFocus();
  render(<Part home={home} />);
  act(() => screen.getByRole('button').focus());
  await userEvent.setup().keyboard('{Enter}');
  const place = home ? screen.getByRole('textbox') : screen.getByRole('region');
  await vi.waitFor(() => expect(document.activeElement).toBe(place));
  end();
});

it('goes to the page where all that was around it went away', async () => {
  const end = keepFocus();
  const box = render(<Part home={false} />);
  render(<main tabIndex={-1} />);
  act(() => screen.getByRole('button').focus());
  box.unmount();
  box.container.remove();
  await vi.waitFor(() => expect(document.activeElement).toBe(screen.getByRole('main')));
  end();
});
