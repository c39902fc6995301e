import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { useOverlays } from '@/state/overlays';

import { FavouritesBox } from './favourites-box';

it('is ready for another one when one is kept: what was kept does not stand there as if it were not', async () => {
  const asked: Asked[] = [];
  vi.stubGlobal('fetch', network({}, asked));
  useOverlays.getState().set('favourites');
  const user = userEvent.setup();
  render(<FavouritesBox />);
  const [name, words] = [screen.getByRole('textbox', { name: 'Name' }), screen.getByRole('textbox', { name: /What to say/ })];
  await user.type(name, 'Round');
  await user.type(words, 'go to the door');
  await user.click(screen.getByRole('button', { name: 'Keep' }));
  await vi.waitFor(() => expect([name, words].map((field) => (field as HTMLInputElement).value)).toEqual(['', '']));
  expect(asked).toMatchObject([{ method: 'PUT', body: { words: 'go to the door' } }]);
});
