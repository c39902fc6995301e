/** What operators do, in a real browser with a real system behind the page. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, CHROMIUM, hasBrowser, robotNamed, say, sizes, startStage, steps, untilItMoved, type Stage } from './stage';

if (!hasBrowser) console.warn(`The stories in the browser are skipped: there is no Chromium at ${CHROMIUM}.`);

describe.skipIf(!hasBrowser)('an operator', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('gets a robot moving with one tap after opening the page on a phone', async () => {
    const page = await stage.open(sizes.phone);
    const from = await robotNamed(stage);
    await page.getByRole('button', { name: 'Go to the dining table.' }).tap();
    await page.getByText('I will go to the dining table').waitFor();
    await untilItMoved(stage, from);
    const fares = page.getByRole('group', { name: 'How David fares' });
    await fares.getByText('1 of 1: Go to “dining table”').waitFor();
    expect(await fares.innerText()).toMatch(/^David\s+Working\s+(Living|Dining) room\s+\d+ %\s+1 of 1: Go to “dining table”\s+0:\d\d( to go)?$/);
    expect((await page.getByRole('banner').boundingBox())?.height).toBeLessThanOrEqual(56);
  });

  it('sees the steps of the plan and what each was given', async () => {
    const page = await stage.open(sizes.desktop);
    await steps(page).getByText(/Working on it|Done/).first().waitFor();
    await steps(page).getByRole('button', { name: /^1\. / }).first().click();
    await steps(page).getByText('Given', { exact: true }).waitFor();
  });

  it('stops the robot by pressing Escape twice and releases it deliberately', async () => {
    const page = await stage.open(sizes.desktop);
    await page.getByText('Connected', { exact: true }).waitFor();
    await page.keyboard.press('Escape');
    await page.keyboard.press('Escape');
    await page.getByText('David is stopped and stays so until it is released.').waitFor();
    await page.getByText('Stands still (measured)').waitFor();
    expect(await page.getByRole('group', { name: 'How David fares' }).innerText()).toMatch(/Stopped[^]*1 of 1: Go to “dining table”$/);

    const other = await stage.open(sizes.phone);
    await other.getByText('David is stopped and stays so until it is released.').waitFor();

    await page.getByRole('button', { name: 'Release…' }).click();
    await page.getByRole('button', { name: 'Yes, it is safe' }).click();
    await page.getByText('David is stopped').waitFor({ state: 'detached' });
  });

  it('picks one of several meanings with one tap', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'cancel everything');
    await say(page, 'Go to the sofa.');
    const choices = page.getByRole('group', { name: 'Possible answers' });
    await choices.getByRole('button', { name: 'small sofa' }).click();
    await page.getByText('I will go to the small sofa').waitFor();
    expect(await choices.count()).toBe(0);
    await say(page, 'never mind');
    await page.getByText('I have stopped. Say “carry on” when I should go on.').waitFor();
    await say(page, 'drive to the sofa');
    await choices.waitFor();
    await say(page, 'leave it');
    await page.getByText('All right, then I leave it.').waitFor();
    await say(page, 'cancel everything');
    await page.goto(`${stage.system.address}#/log`);
    await page.getByRole('heading', { name: 'Go to the sofa.' }).first().waitFor(); // not what was tapped
  });

  it('keeps a round under a name, runs it by that name without one of its parts, and by a tap', async () => {
    const page = await stage.open(sizes.phone);
    await page.getByRole('button', { name: 'Favourites' }).tap();
    const box = page.getByRole('dialog', { name: 'Favourites' });
    await box.getByLabel('Name').fill('Evening round');
    await box.getByLabel('What to say').fill('go to the bed\ngo to the bookshelf');
    await box.getByRole('button', { name: 'Keep' }).tap();
    await box.getByText('Evening round', { exact: true }).waitFor();
    expect(await barriers(page)).toEqual([]);
    await box.getByRole('button', { name: 'Close' }).tap();

    const said = page.locator('li[data-mine="true"]').last();
    await say(page, 'evening round, but skip the fridge');
    await page.getByText(/^“the fridge” is not one part of it, so nothing was sent/).waitFor();
    await say(page, 'evening round, but skip the bed');
    await said.getByText('go to the bookshelf', { exact: true }).waitFor();
    await page.getByText('I will go to the bookshelf.').waitFor();

    const other = await stage.open(sizes.desktop);
    await other.getByRole('button', { name: 'Favourites' }).click();
    await other.getByRole('button', { name: 'Run “Evening round” by David' }).click();
    await said.getByText('Go to the bed. Go to the bookshelf.', { exact: true }).waitFor();
    await page.getByText('I will go to the bed and then go to the bookshelf.').waitFor();
  });

  it('finds the same conversation after opening the page again', async () => {
    const page = await stage.open(sizes.tablet);
    await page.getByText('Go to the sofa.').first().waitFor();
    expect(await page.getByText('Go to the sofa.', { exact: true }).count()).toBe(1);
  });

  it('finds what was said by a word of it', async () => {
    const page = await stage.open(sizes.desktop);
    await page.getByRole('button', { name: 'Search the conversation' }).click();
    await page.getByRole('search').getByRole('textbox').fill('dining');
    await page.getByRole('search').getByText('Go to the dining table.').first().waitFor();
  });

  it('has the plan on a page of its own on a phone', async () => {
    const page = await stage.open(sizes.phone);
    await page.getByRole('link', { name: 'Plan' }).tap();
    await page.getByRole('heading', { name: 'Plan' }).waitFor();
    const menu = page.getByRole('button', { name: 'Menu' });
    expect((await menu.boundingBox())?.y).toBeGreaterThan(sizes.phone.height * 0.6); // where a thumb is
    await menu.tap();
    await page.getByRole('dialog', { name: 'Menu' }).getByRole('link', { name: 'Chat' }).tap();
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
  });
});
