/** Two robots, and two people with a page each. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, robotNamed, say, sizes, startStage, untilItMoved, type Stage } from './stage';

const tab = (page: Page, name: string) =>
  page.getByRole('group', { name: 'Robots you talk to' }).getByRole('button', { name: new RegExp(`^${name}`) });

/** What the conversation shows, as texts. */
const said = (page: Page) => page.locator('ol > li > div:first-of-type > p').allTextContents();

describe.skipIf(!hasBrowser)('people with two robots', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage([], 'two-robots');
  });

  afterAll(async () => {
    await stage.close();
  });

  it('talk to both at once by a click with Shift, and see what was said once', async () => {
    const page = await stage.open(sizes.desktop);
    await tab(page, 'David').click();
    await tab(page, 'Ruth').click({ modifiers: ['Shift'] });
    await page.getByRole('textbox', { name: 'Write to David and Ruth' }).waitFor();
    await say(page, 'what can you do?');
    const replies = page.getByText(/I can /);
    await replies.nth(1).waitFor();
    expect(await page.getByText('what can you do?', { exact: true }).count()).toBe(1);
    await tab(page, 'David').click({ modifiers: ['Shift'] });
    await page.getByRole('textbox', { name: 'Write to Ruth' }).waitFor();
    expect(await replies.count()).toBe(1);
  });

  it('choose a second robot on a tablet by a long touch', async () => {
    const page = await stage.open(sizes.tablet);
    await tab(page, 'David').tap();
    const box = await tab(page, 'Ruth').boundingBox();
    if (!box) throw new Error('the tab is not to be seen');
    const touch = await page.context().newCDPSession(page);
    const touchPoints = [{ x: box.x + box.width / 2, y: box.y + box.height / 2 }];
    await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints });
    await page.getByRole('textbox', { name: 'Write to David and Ruth' }).waitFor();
    await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
    await page.getByRole('button', { name: 'Search the conversation' }).tap();
    expect(await page.getByRole('textbox', { name: 'Write to David and Ruth' }).count()).toBe(1);
  });

  it('see the same on both pages, whoever does something', async () => {
    const [one, two] = await Promise.all([stage.open(sizes.desktop), stage.open(sizes.phone)]);
    await tab(one, 'David').click();
    await tab(two, 'David').tap();
    await say(one, 'remember that the keys are in the drawer');
    await two.getByText('remember that the keys are in the drawer', { exact: true }).waitFor();
    await say(two, 'Go to the sofa.');
    const choice = one.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: 'large sofa' });
    await choice.waitFor();
    await two.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: 'large sofa' }).tap();
    await choice.waitFor({ state: 'detached' });
    await Promise.all([one, two].map((page) => page.getByText('I will go to the large sofa').waitFor()));
    expect(await said(two)).toEqual(await said(one));
  });

  it('stop one of them while both drive, and see it sent and standing', async () => {
    const page = await stage.open(sizes.desktop);
    await tab(page, 'David').click();
    await say(page, 'Go to the refrigerator.');
    await tab(page, 'Ruth').click();
    const from = await robotNamed(stage, 'Ruth');
    await say(page, 'Go to the wardrobe.');
    await untilItMoved(stage, from);
    await page.getByRole('button', { name: 'Which robots to stop' }).click();
    await page.getByRole('menuitem', { name: 'Stop only Ruth' }).click();
    await page.locator('li[data-reached="true"]', { hasText: 'Sent' }).waitFor();
    await page.locator('li[data-reached="true"]', { hasText: 'Standing still' }).waitFor();
    await page.getByText('Ruth is stopped and stays so until you release it.').waitFor();
    expect((await robotNamed(stage, 'Ruth'))?.state).toBe('stopped');
    expect((await robotNamed(stage, 'David'))?.state).not.toBe('stopped');
    await page.getByRole('button', { name: 'Release…' }).click();
    await page.getByRole('button', { name: 'Yes, it is safe' }).click();
    await page.getByText('Ruth is stopped').waitFor({ state: 'detached' });
  });

  it('see when a robot falls silent, and go on with the other one', async () => {
    const page = await stage.open(sizes.desktop);
    await tab(page, 'Ruth').waitFor();
    stage.system.tell('vanish Ruth');
    await page.getByText('Ruth is not connected').first().waitFor({ state: 'attached' });
    await page.goto(`${stage.system.address}#/robots`);
    await page.getByRole('region', { name: 'Robots' }).getByText('Ruth', { exact: true }).waitFor();
    await page.goto(`${stage.system.address}#/`);
    await tab(page, 'David').click();
    await say(page, 'what do you remember about the keys?');
    await page.getByText(/drawer/).last().waitFor();
  });
});
