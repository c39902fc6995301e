/** Two robots, and two people with a page each. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, robotNamed, say, sizes, startStage, untilItMoved, type Stage } from './stage';

const tab = (page: Page, name: string) =>
  page.getByRole('group', { name: 'Robots you talk to' }).getByRole('button', { name: new RegExp(`^${name}`) });

interface Entry {
  id: string;
  who: string;
  message: string;
  targets: string[];
  question: string;
  reply_to: string;
}

interface Plan {
  kind: string;
  steps: { call: Record<string, unknown> }[];
}

/** What a robot's plan says of places, as text. */
async function placesOf(stage: Stage, robot: string): Promise<string> {
  const plans = await stage.get<Plan[]>(`plans/${robot}`);
  return JSON.stringify(plans.filter((plan) => plan.kind === 'plan').map((plan) => plan.steps.map((step) => step.call)));
}

/** What the conversation shows, as texts. */
const said = (page: Page) =>
  page.getByRole('region', { name: 'Conversation' }).locator('li > div:first-of-type > p').allTextContents();

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

  it('answer the one that asks and order the other with the same words', async () => {
    const page = await stage.open(sizes.desktop);
    await tab(page, 'David').click();
    await say(page, 'remember that John is on the sofa');
    await page.getByText('I will remember that John is on the sofa.').first().waitFor();
    await say(page, 'go to John');
    await page.getByText(/^David asks:/).waitFor();
    await tab(page, 'Ruth').click({ modifiers: ['Shift'] });
    await page.getByText('David gets this as the answer, Ruth as a new request.').waitFor();
    await say(page, 'go to the large sofa');
    await page.getByText(/^David asks:/).waitFor({ state: 'detached' });
    const { entries } = await stage.get<{ entries: Entry[] }>('chat');
    const asked = entries.findLast((entry) => entry.question !== '' && entry.targets.includes('David'));
    const answer = entries.findLast((entry) => entry.who === 'operator');
    expect(asked?.question).toBe('answered');
    expect(answer).toMatchObject({ message: 'go to the large sofa', targets: ['David', 'Ruth'], reply_to: asked?.id });
    // One goes on with what it was at, the other begins something new.
    for (const robot of ['David', 'Ruth']) {
      await expect.poll(async () => placesOf(stage, robot), { timeout: 30_000 }).toContain('large sofa');
    }
    await page.getByText('I will go to the large sofa.').first().waitFor();
    const replies = (await stage.get<{ entries: Entry[] }>('chat')).entries.filter((entry) => entry.reply_to === answer?.id);
    expect(replies.map((entry) => entry.targets)).toContainEqual(['Ruth']);
    await say(page, 'cancel everything'); // there is no room for two in front of it
    for (const robot of ['David', 'Ruth']) {
      await expect.poll(async () => (await robotNamed(stage, robot))?.state, { timeout: 60_000 }).toBe('idle');
    }
  }, 120_000);

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
    await page.getByText('Stands still (measured)').waitFor();
    await page.getByText('Ruth is stopped and stays so until it is released.').waitFor();
    expect((await robotNamed(stage, 'Ruth'))?.state).toBe('stopped');
    expect((await robotNamed(stage, 'David'))?.state).not.toBe('stopped');
    await page.getByRole('button', { name: 'Release…' }).click();
    await page.getByRole('button', { name: 'Yes, it is safe' }).click();
    await page.getByText('Ruth is stopped').waitFor({ state: 'detached' });
  });

  it('see when a robot falls silent, and go on with the other one', async () => {
    const page = await stage.open(sizes.desktop);
    await tab(page, 'Ruth').click();
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
