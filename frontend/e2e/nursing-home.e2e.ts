/** The story of the nursing home, as an operator lives it: told in the chat, seen on the page, over a restart. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, robotNamed, say, sizes, startStage, steps, type Stage } from './stage';

const SMALL_SOFA = { x: 5.28, y: 0.95 };

describe.skipIf(!hasBrowser)('an operator in the nursing home', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--speed', '6']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('tells the robot two things, asks for a third, helps twice, and sees it done', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'John is on the sofa.');
    await page.getByText('I will remember that John is on the sofa').waitFor();
    await say(page, 'There is a water bottle in the fridge.');
    await page.getByText(/I will remember that there is a water bottle/i).waitFor();

    await say(page, 'Bring me my glasses.'); // what a reply lacks is asked for like anything else
    const lacks = page.locator('li[data-question="open"]').filter({ hasText: 'glasses' });
    await lacks.waitFor();
    await expect.poll(() => page.title()).toBe('(1) Parley');
    await page.getByRole('button', { name: 'Never mind' }).click();
    await page.getByText('All right, then I leave it.').waitFor();
    expect([await lacks.count(), await page.title()]).toEqual([0, 'Parley']);
    await say(page, 'Bring me my glasses.');
    await lacks.waitFor();
    expect((await stage.get<{ waits: string[] }>('history/handover?since=1')).waits).toEqual([expect.stringMatching(/^David asks: .*glasses/)]);

    await stage.system.end();
    await page.getByText(/The connection is lost since/).waitFor();
    await stage.system.start();
    await page.getByText(/The connection is lost since/).waitFor({ state: 'detached' });
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await expect.poll(() => page.title()).toBe('Parley'); // it knows no more that it asked
    expect(await lacks.count()).toBe(0);

    await say(page, 'John is thirsty, get him water.');
    const cards = steps(page).locator('li[data-state]');
    await page.getByText(/, step \d of 4$/).waitFor();
    const question = page.locator('li[data-question="open"]');
    await question.waitFor();
    expect(await question.innerText()).toMatch(/water bottle/);
    await page.getByRole('region', { name: 'Pictures' }).getByRole('img').first().waitFor();
    await page.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: 'It is on you' }).click();

    await page.getByText(/, step 4 of 4$/).waitFor(); // that the search failed is told in the step it is made for
    expect(await cards.allInnerTexts()).toEqual([expect.stringMatching(/^4. Go to “sofa”[^]*Several places fit/)]);
    await page.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: 'small sofa' }).click();
    await expect.poll(() => cards.count(), { timeout: 60_000 }).toBeGreaterThan(0);
    await page.getByText('Ended', { exact: true }).waitFor();
    expect(await cards.evaluateAll((all) => all.map((card) => (card as HTMLElement).dataset.state))).toEqual(
      Array(await cards.count()).fill('finished'),
    );
    const pose = (await robotNamed(stage))?.pose;
    expect(Math.hypot((pose?.x ?? 99) - SMALL_SOFA.x, (pose?.y ?? 99) - SMALL_SOFA.y)).toBeLessThan(2);
    expect(await page.locator('li[data-question="open"]').count()).toBe(0);
  });
});
