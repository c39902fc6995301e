/** The story of the warehouse, as somebody at a desk lives it: which area, what is in the way, and home. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, steps, type Stage } from './stage';

const DOCK = { x: 0.45, y: 1.2 };

describe.skipIf(!hasBrowser)('somebody who gets a shipment ready', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--speed', '8'], 'warehouse');
  });

  afterAll(async () => {
    await stage.close();
  });

  it('is asked which area, told what is there and what is in the way, and sends the robot home', async () => {
    const page = await stage.open(sizes.desktop);
    const told = (what: RegExp) => page.locator('li[data-entry]').filter({ hasText: what });
    const seen = (what: RegExp) => told(what).getByRole('img', { name: 'What Spot saw' });

    await say(page, "We need to prepare for tomorrow's shipment. First, check if the package is in the storage area. Then verify if the loading area is clear.");
    const answers = page.getByRole('group', { name: 'Possible answers' });
    await answers.getByRole('button', { name: /Component B storing area/i }).first().click();
    await seen(/I can see the package/).waitFor();
    await seen(/blue cylinder at the edge/).waitFor();
    await page.locator('li[data-question="open"]').filter({ hasText: /blue cylinder/ }).waitFor();
    await steps(page).getByText('Found something', { exact: true }).waitFor();
    expect(await barriers(page)).toEqual([]);
    await expect.poll(() => stage.system.output(), { timeout: PATIENCE_MS }).toContain('somebody takes the blue cylinder away');

    await say(page, 'The loading area has been cleared. Please return to the charging dock.');
    await seen(/nothing standing in the loading area/).waitFor();
    await page.getByText('Ended', { exact: true }).waitFor();
    const pose = (await robotNamed(stage, 'Spot'))?.pose;
    expect(Math.hypot((pose?.x ?? 99) - DOCK.x, (pose?.y ?? 99) - DOCK.y)).toBeLessThan(2);
    expect(await page.locator('li[data-question="open"]').count()).toBe(0);
  });
});
