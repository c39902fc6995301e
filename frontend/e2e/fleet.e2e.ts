/** Several robots at one order, on a phone. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, type Stage } from './stage';

const ROBOTS = ['Spot', 'TIAGo', 'Leo'];

describe.skipIf(!hasBrowser)('people with a team', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage([], 'fleet');
  });

  afterAll(async () => {
    await stage.close();
  });

  it('see one order as one, begin it with one yes, cancel one part of it and read how it ended', async () => {
    for (const robot of ROBOTS) {
      await expect.poll(() => robotNamed(stage, robot), { timeout: PATIENCE_MS }).toBeTruthy();
      await fetch(`${stage.system.address}api/plans/${robot}/policy`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ policy: 'ask_first' }),
      });
    }
    const page = await stage.open(sizes.phone);
    await page.getByRole('textbox', { name: /^Write to/ }).waitFor();
    await say(page, 'Check all three areas, split between you.');
    const card = page.getByRole('article', { name: /^Together: / });
    const yes = card.getByRole('button', { name: 'Yes, begin all 3 parts' });
    await yes.waitFor();
    await card.getByRole('button', { name: /^Together: / }).tap();
    for (const robot of ROBOTS) await card.getByRole('listitem').filter({ hasText: robot }).waitFor();
    expect(await barriers(page)).toEqual([]);
    const desk = await stage.open(sizes.desktop);
    const tabs = desk.getByRole('group', { name: 'Robots you talk to' });
    for (const robot of ROBOTS) await tabs.getByRole('button', { name: `${robot} is waiting for your answer` }).waitFor();
    const cut = (row: Element) => row.scrollWidth > row.clientWidth || row.scrollHeight > row.clientHeight;
    expect(await tabs.evaluate(cut)).toBe(false);
    await desk.locator('svg text').getByText('Area A', { exact: true }).waitFor();
    await desk.close(); // its cameras cost the robots time
    await yes.tap();
    await card.getByRole('button', { name: 'Cancel the part of Leo' }).tap();
    await card.getByRole('listitem').filter({ hasText: 'Leo' }).getByText('Ended early').waitFor();
    const end = page.getByText(/has ended\. Leo left out: /);
    await end.first().waitFor();
    expect(await end.first().textContent()).not.toMatch(/Spot|TIAGo/);
    expect(await card.count()).toBe(0);
  });
});
