/** The story of the car park, as a guard with a phone lives it. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, say, sizes, startStage, type Stage } from './stage';

describe.skipIf(!hasBrowser)('a guard in the car park', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--speed', '8'], 'parking');
  });

  afterAll(async () => {
    await stage.close();
  });

  it('has three areas looked through, is shown the bag that somebody left, and has it looked at', async () => {
    const page = await stage.open(sizes.phone);
    const asks = page.getByRole('region', { name: 'TIAGo waits for your yes' });
    const told = (what: RegExp) => page.locator('li[data-entry]').filter({ hasText: what });
    const seen = (what: RegExp) => told(what).getByRole('img', { name: 'What TIAGo saw' });

    await say(page, 'There are three areas of interest: Area A, Area B, and Area C.');
    await told(/^TIAGo\s*I will remember/).waitFor();
    await say(page, 'Can you inspect each area of interest for any suspicious bags?');
    await asks.getByRole('button', { name: 'Yes, begin 6 steps' }).tap();
    await seen(/no suspicious bags in Area A/).waitFor();
    await seen(/no suspicious bags in Area B/).waitFor();
    await expect.poll(() => stage.system.output(), { timeout: PATIENCE_MS }).toContain('somebody leaves a bag in area C');

    await seen(/^I can see a black bag in Area C/).waitFor();
    await page.locator('li[data-question="open"]').filter({ hasText: /black bag in Area C.* I have stopped here/ }).waitFor();
    expect(await barriers(page)).toEqual([]);
    await say(page, 'Go to the bag and inspect it further.');
    await asks.getByRole('button', { name: 'Yes, begin 2 steps' }).tap();
    await seen(/I can see the black bag/).waitFor();
    await told(/I have finished/).waitFor();
    expect(await page.locator('li[data-question="open"]').count()).toBe(0);

    await page.getByRole('button', { name: 'Menu' }).tap();
    await page.getByRole('dialog', { name: 'Menu' }).getByRole('link', { name: 'History' }).tap();
    const round = page.getByRole('listitem').filter({ has: page.getByRole('heading', { name: 'Can you inspect each area of interest for any suspicious bags?' }) });
    await round.getByText(/Found: I can see a black bag in Area C/).waitFor();
    expect(await round.getByRole('img').count()).toBe(4); // A, B, C, and the bag from near
  });
});
