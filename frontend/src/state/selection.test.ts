import { expect, it } from 'vitest';

import { effective, useSelectionStore } from './selection';

it('is the same after the page was loaded again: nobody writes to another robot unawares', async () => {
  useSelectionStore.getState().only('Ruth');
  const kept = sessionStorage.getItem('parley.chosen') ?? '';
  useSelectionStore.setState({ chosen: [] });
  sessionStorage.setItem('parley.chosen', kept);
  await useSelectionStore.persist.rehydrate();
  expect(effective(useSelectionStore.getState().chosen, ['David', 'Ruth'])).toEqual(['Ruth']);
});

it('is the first robot where none of the chosen ones is there', () => {
  expect(effective(['Kim'], ['David', 'Ruth'])).toEqual(['David']);
});
