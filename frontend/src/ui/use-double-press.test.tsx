import { render, screen } from '@testing-library/react';
import { userEvent } from '@testing-library/user-event';
import { useState } from 'react';
import { expect, it, vi } from 'vitest';

import { Button } from './button';
import { useDoublePress } from './use-double-press';

const said = vi.fn();

/** What is pressed makes way for the next, as answers of a robot that asks again do. */
function Asking() {
  useDoublePress();
  const [number, setNumber] = useState(1);
  const press = () => {
    said(number);
    setNumber(number + 1);
  };
  return (
    <>
      <Button key={number} onPress={press}>{`Answer ${number}`}</Button>
      <Button onPress={() => said('nearer')}>Nearer</Button>
      <div data-once>
        <Button onPress={() => said('skip')}>Skip</Button>
      </div>
    </>
  );
}

it('takes a double press for one where something else has come under the finger', async () => {
  render(<Asking />);
  const user = userEvent.setup();
  await user.click(screen.getByRole('button', { name: 'Answer 1' }));
  await user.click(screen.getByRole('button', { name: 'Answer 2' }));
  expect(said.mock.calls).toEqual([[1]]);
  await user.dblClick(screen.getByRole('button', { name: 'Nearer' }));
  expect(said.mock.calls).toEqual([[1]]); // jsdom has every button at one place
  vi.spyOn(Date, 'now').mockReturnValue(Date.now() + 1000);
  await user.dblClick(screen.getByRole('button', { name: 'Nearer' }));
  await user.keyboard('{Enter}');
  expect(said.mock.calls).toEqual([[1], ['nearer'], ['nearer'], ['nearer']]);
  vi.restoreAllMocks();
});

it('takes two presses with a key between them for two', async () => {
  said.mockClear();
  render(<Asking />);
  const user = userEvent.setup();
  await user.click(screen.getByRole('button', { name: 'Answer 1' }));
  await user.keyboard('{Escape}');
  await user.click(screen.getByRole('button', { name: 'Answer 2' }));
  expect(said.mock.calls).toEqual([[1], [2]]);
});

it('takes a double press of what is done once for one, and a later one for another', async () => {
  said.mockClear();
  render(<Asking />);
  const user = userEvent.setup();
  await user.dblClick(screen.getByRole('button', { name: 'Skip' }));
  expect(said.mock.calls).toEqual([['skip']]);
  vi.spyOn(Date, 'now').mockReturnValue(Date.now() + 1000);
  await user.click(screen.getByRole('button', { name: 'Skip' }));
  expect(said.mock.calls).toEqual([['skip'], ['skip']]);
  vi.restoreAllMocks();
});
