/** Rules are made, tried and dropped by hand, and hold for a robot that is asked. */
import { mkdirSync } from 'node:fs';

import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, say, sizes, startStage, type Stage } from './stage';

const PICTURES = 'screenshots/rules';

describe.skipIf(!hasBrowser)('rules', () => {
  let stage: Stage;

  beforeAll(async () => {
    mkdirSync(PICTURES, { recursive: true });
    stage = await startStage(['--speed', '8']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('are made without a mouse, tried, seen on the map, and hold', async () => {
    const page = await stage.open(sizes.desktop, '#/rules');
    await page.getByText('There are no rules.').waitFor();
    await page.getByRole('button', { name: 'Add a rule' }).press('Enter');
    await page.getByRole('textbox', { name: 'What the place is called' }).fill('fridge corner');
    await page.getByRole('textbox', { name: 'Corners' }).fill('0.2,4.9 2.4,7.2');
    await page.screenshot({ path: `${PICTURES}/form.png`, fullPage: true });
    expect(await barriers(page)).toEqual([]);
    await page.getByRole('button', { name: 'Let it hold' }).press('Enter');
    await page.getByText('Stays out of “fridge corner”: every robot.').waitFor();

    await page.getByRole('textbox', { name: 'Places, one per line' }).fill('fridge');
    await page.getByRole('button', { name: 'Try it' }).press('Enter');
    await page.getByText('Step 1 leads into “fridge corner”, where David must not go.').waitFor();
    expect(await barriers(page)).toEqual([]);
    await page.screenshot({ path: `${PICTURES}/tried.png`, fullPage: true });

    await page.goto(`${stage.system.address}#/map`);
    await page.locator('svg polygon[data-kind=keep_out]').waitFor({ state: 'attached' });
    await page.screenshot({ path: `${PICTURES}/map.png` });

    await page.goto(`${stage.system.address}#/`);
    await say(page, 'Go to the fridge.');
    await page.getByText(/fridge corner.*David must not go/).first().waitFor();
  });

  it('are drawn on the map, shown as what they become, and hold after a yes', async () => {
    const page = await stage.open(sizes.phone, '#/map');
    await page.getByRole('button', { name: 'Draw an area for a rule' }).tap();
    const box = await page.getByRole('application').boundingBox();
    if (!box) throw new Error('the map is not there');
    await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.6);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.7, box.y + box.height * 0.7, { steps: 4 });
    await page.mouse.up();
    await page.getByText('It becomes this rule: Stays out of “part of the').waitFor();
    expect(await barriers(page)).toEqual([]);
    expect((await stage.get<{ rules: unknown[] }>('rules')).rules).toHaveLength(1);
    await page.getByRole('button', { name: 'Let it hold' }).tap();
    await expect.poll(() => page.locator('svg polygon[data-kind=keep_out]').count()).toBe(2);
    expect((await stage.get<{ rules: unknown[] }>('rules')).rules).toHaveLength(2);
  });

  it('are drawn with a mouse and dropped after a second yes', async () => {
    const page = await stage.open(sizes.desktop, '#/rules');
    await page.getByRole('button', { name: 'Add a rule' }).click();
    const map = page.locator('svg[data-drawn=true]');
    await map.scrollIntoViewIfNeeded();
    const box = await map.boundingBox();
    if (!box) throw new Error('the map is not there');
    await page.mouse.move(box.x + box.width * 0.4, box.y + box.height * 0.4);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.6, { steps: 4 });
    await page.mouse.up();
    await expect.poll(() => page.getByRole('textbox', { name: 'Corners' }).inputValue()).toMatch(/^-?[\d.]+,-?[\d.]+ -?[\d.]+,-?[\d.]+$/);
    await page.getByRole('textbox', { name: 'What the place is called' }).fill('middle');
    await page.getByRole('button', { name: 'Let it hold' }).click();
    await page.getByText('Stays out of “middle”').waitFor();
    await page.getByRole('button', { name: /^Drop: Stays out of “middle”/ }).click();
    await page.getByRole('button', { name: /^Yes, drop it: Stays out of “middle”/ }).click();
    await page.getByText('Stays out of “middle”').waitFor({ state: 'detached' });
  });

  it('are told in the chat and count after a yes', async () => {
    const page = await stage.open(sizes.phone, '#/');
    await say(page, 'never drive faster than 0.1 m/s at night');
    await page.getByText('I understand this as a rule: Not faster than 0.1 m/s between 22:00 and 06:00').first().waitFor();
    await page.getByRole('button', { name: 'Yes', exact: true }).click();
    await page.getByText('The rule holds from now on').first().waitFor();
    await page.goto(`${stage.system.address}#/rules`);
    await page.getByText('Told: “never drive').first().waitFor();
    await page.screenshot({ path: `${PICTURES}/phone.png`, fullPage: true });
    expect(await barriers(page)).toEqual([]);
  });

  it('that are told of a place show it on the map before the yes', async () => {
    const page = await stage.open(sizes.desktop, '#/');
    const drawn = page.locator('[data-rule-map] polygon[data-kind=keep_out], polygon[data-wished]');
    await say(page, 'nobody into the kitchen at night');
    await expect.poll(() => drawn.count()).toBe(2);
    await page.screenshot({ path: `${PICTURES}/told.png` });
    expect(await barriers(page)).toEqual([]);
    await page.getByRole('button', { name: 'No', exact: true }).first().click();
    await expect.poll(() => drawn.count()).toBe(0);
  });
});
