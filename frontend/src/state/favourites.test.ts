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

it.each([
  ['check bay 1, bay 2 and bay 3', 'bay 2', 'check bay 1 and bay 3'],
  ['scan bay 1 and bay 2', 'bay 1', 'scan bay 2'],
  ['check bay 1, bay 2, and bay 3.', 'bay 3', 'check bay 1, and bay 2'],
  ['check bay 1, bay 2 and bay 3', 'the bay 1', 'check bay 2 and bay 3'],
  ['Look at the box and the lamp.', 'the box', 'Look at the lamp'],
  ['Look at the box and the lamp.', 'lamp', 'Look at the box'],
  ['check bay 1, bay 2 and bay 3 for leaks', 'bay 2', 'check bay 1 and bay 3 for leaks'],
  ['Go to bay 1. Look at bay 2. Go home.', 'bay 2', 'Go to bay 1. Go home.'],
  ['go to bay 1, then look at the box and go to the desk', 'the box', 'Go to bay 1. Go to the desk.'],
  ['go to bay 1 and check bay 2 and bay 3', 'bay 3', 'Go to bay 1. Check bay 2.'],
  ['check all bays', 'bay 2', 'check all bays, except bay 2'],
  ['check bay 1 and bay 2\ngo home', 'bay 2', 'Check bay 1. Go home.'],
])('leaves out a part of one sentence: %s, without %s', (words, out, left) => {
  expect(meantBy(`round, but skip ${out}`, [{ name: 'Round', words }])).toEqual({ words: left });
});

it.each([
  ['check bay 1 and bay 2 for leaks', 'bay 2'], // whether the rest is looked at for leaks nobody knows
  ['check bay 1, bay 2 and bay 1', 'bay 1'],
  ['check bay 2 and tell me what you see', 'bay 2'],
  ['look at bay 2 and lamp', 'bay 2'],
  ['check the desk', 'bay 2'],
  ['check all bays except bay 2 and bay 3', 'bay 3'],
  ['bring the box from bay 1 and put it on the desk', 'the desk'],
  ['go to bay 1\nlook at it closely', 'bay 1'],
  ['check all bays\ncheck all desks', 'bay 2'],
])('leaves to the person what would be guessed: %s, without %s', (words, out) => {
  expect(meantBy(`round, but skip ${out}`, [{ name: 'Round', words }])).toEqual({ unclear: out });
});

it.each([
  ['mine boksi 1 juurde\nmine boksi 2 juurde\nmine boksi 21 juurde', 'jäta boks 2 vahele', 'Mine boksi 1 juurde. Mine boksi 21 juurde.'],
  ['vaata boksi 1, boksi 2 ja boksi 3', 'jäta boks 2 vahele', 'vaata boksi 1 ja boksi 3'],
  ['vaata boksi 1, boksi 2 ja boksi 3', 'ilma boksita 1', 'vaata boksi 2 ja boksi 3'],
  ['kontrolli köögi akent ja vaata lampi', 'jäta lamp välja', 'kontrolli köögi akent'],
  ['kontrolli kõiki bokse', 'mitte boks 2', 'kontrolli kõiki bokse, välja arvatud boks 2'],
])('leaves out a part in Estonian, in whatever case it stands: %s, %s', (words, change, left) => {
  expect(meantBy(`hommikuring, aga ${change}`, [{ name: 'Hommikuring', words }])).toEqual({ words: left });
});

it.each([
  ['vaata lauda\nmine lauta', 'laud'], // both begin so
  ['too kast ja pane see lauale', 'laud'],
  ['vaata boksi 1 ja boksi 3', 'boks 2'],
])('leaves to the person what would be guessed in Estonian: %s, %s', (words, out) => {
  expect(meantBy(`ring, jäta ${out} vahele`, [{ name: 'Ring', words }])).toEqual({ unclear: out });
});
