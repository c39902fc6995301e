/** Who did what: written down while a robot drives, told in the chat, shown on a page. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, say, sizes, startStage, steps, type Stage } from './stage';

describe.skipIf(!hasBrowser)('the log', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('knows who sent a robot and who stopped it, and the robot says so when asked', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'who sent you there?');
    await page.getByText('I do not know: nothing about it is written down.').waitFor();
    await say(page, 'Go to the dining table.');
    await steps(page).getByText('Working on it').first().waitFor();
    await say(page, 'who sent you there?');
    await page.getByText(/told me at \d\d:\d\d: “Go to the dining table”\./).waitFor();
    await page.getByRole('button', { name: /^Stop/ }).first().click();
    await page.getByText('David is stopped and stays so until it is released.').waitFor();
    await say(page, 'kes su peatas?');
    await page.getByText(/peatas mu kell \d\d:\d\d/).waitFor();
  });

  it('is a page that tells it in sentences, by words and by kind, with the keyboard alone', async () => {
    const page = await stage.open(sizes.desktop, '#/log');
    await page.getByText(/^Unbroken since/).waitFor();
    await page.getByText(/said “Go to the dining table\.” to David\./).waitFor();
    await page.getByLabel('Search the log').focus();
    await page.keyboard.type('dining');
    await page.getByText(/stands still/).first().waitFor({ state: 'detached' });
    expect(await page.getByRole('listitem').filter({ hasText: 'dining' }).count()).toBeGreaterThan(1);
    await page.keyboard.press('Tab');
    await page.keyboard.type('nobody here');
    await page.getByText('Nothing found.').waitFor();
    expect(await barriers(page)).toEqual([]);
  });
});
