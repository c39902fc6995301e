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

  it('is a page that says what robots did, what the next shift has to know, and who did what, with the keyboard alone', async () => {
    const page = await stage.open(sizes.desktop, '#/log');
    const round = page.getByRole('listitem').filter({ has: page.getByRole('heading', { name: 'Go to the dining table.' }) });
    await round.getByText('Not over yet').waitFor();
    const address = await round.getByRole('link', { name: /^Save with pictures/ }).getAttribute('href');
    expect(await (await fetch(new URL(address ?? '', stage.system.address))).text()).toContain('<h1>Go to the dining table.</h1>');
    expect(await barriers(page)).toEqual([]);

    await page.getByRole('button', { name: 'Handover' }).focus();
    await page.keyboard.press('Enter');
    const sheet = page.getByRole('article');
    await sheet.getByText(/^David is stopped until somebody releases it, with steps left: Go to/).waitFor();
    expect(await sheet.innerText()).toMatch(/\d\d:\d\d .* to David: Go to the dining table\.[^]*Stops[^]*stopped all robots\./);
    await page.emulateMedia({ media: 'print' });
    expect(await page.getByRole('button', { name: 'Print' }).isVisible()).toBe(false);
    await page.emulateMedia({ media: 'screen' });

    await page.getByRole('button', { name: 'Who did what' }).press('Enter');
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
