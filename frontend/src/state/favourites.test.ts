import { expect, it } from 'vitest';

import { meantBy } from './favourites';

const round = { name: 'Morning round', words: 'go to bay 1\ngo to bay 2\ngo to bay 21\nlook at the box' };
const kept = [{ name: 'Morning', words: 'go to the door' }, round];
const said = (text: string) => meantBy(text, kept);

it('is said by its name alone, the longest name that fits', () => {
  expect(said(' morning round. ')).toEqual({ words: 'Go to bay 1. Go to bay 2. Go to bay 21. Look at the box.' });
  expect(said('Morning')).toEqual({ words: 'go to the door' });
  expect(said('mornings are cold')).toBeNull();
  expect(said('do the morning round')).toBeNull();
});

it.each(['but skip bay 2', 'without bay 2', 'but not the bay 2', 'aga jäta bay 2 vahele'])('leaves out what is named: %s', (change) => {
  expect(said(`morning round, ${change}`)).toEqual({ words: 'Go to bay 1. Go to bay 21. Look at the box.' });
});

it('goes on with more, and leaves to the person what is not plain', () => {
  expect(said('morning, then go to bay 3')).toEqual({ words: 'Go to the door. Go to bay 3.' });
  expect(said('morning round, but skip bay 7')).toEqual({ unclear: 'bay 7' });
  expect(said('morning round, but skip bay')).toEqual({ unclear: 'bay' });
  expect(said('morning, but skip the door')).toEqual({ unclear: 'the door' });
  expect(said('morning round, backwards')).toEqual({ unclear: 'backwards' });
});
