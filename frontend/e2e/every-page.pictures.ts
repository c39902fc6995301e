/** Pictures of every page in each size and look, with a real system in the middle of a task. Run: npm run screenshots */
import { mkdirSync } from 'node:fs';

import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, say, sizes, startStage, type Stage } from './stage';

const FOLDER = 'screenshots';
const SETTLED_MS = 700;
const pages = ['chat', 'plan', 'display', 'map', 'memory', 'robots', 'rules', 'incidents', 'log', 'people', 'settings'] as const;
const looks = ['light', 'dark', 'contrast'] as const;

/** A robot that has looked, asked and been answered, and now asks which of two is meant. */
async function midTask(page: Page): Promise<void> {
  await say(page, 'John is on the sofa.');
  await page.getByText('I will remember that John').waitFor();
  await say(page, 'There is a water bottle in the fridge.');
  await page.getByText('I will remember that there is').waitFor();
  await say(page, 'John is thirsty, get him water.');
  await page.getByText(/^David asks:/).waitFor();
  await say(page, 'I have put it on you.');
  await page.getByRole('group', { name: 'Possible answers' }).getByRole('button').first().waitFor();
}

describe.skipIf(!hasBrowser)('every page', () => {
  let stage: Stage;

  beforeAll(async () => {
    mkdirSync(FOLDER, { recursive: true });
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('has something to show', async () => {
    await midTask(await stage.open(sizes.desktop));
  });

  const kinds = Object.entries(sizes).flatMap(([size, box]) => looks.map((look) => [size, look, box] as const));
  it.each(kinds)('is pictured in the size %s and the look %s', async (size, look, box) => {
    const page = await stage.open(box);
    await page.evaluate(
      (theme) => localStorage.setItem('parley.prefs', JSON.stringify({ state: { theme, language: 'en', openNoted: true }, version: 1 })),
      look,
    );
    const found: string[] = [];
    for (const name of pages) {
      await page.goto(`${stage.system.address}#/${name === 'chat' ? '' : name}`);
      if (name === pages[0]) await page.reload();
      await page.getByRole('heading', { level: 2 }).first().waitFor();
      await page.waitForFunction(() => !/Loading…|Waiting for the first picture/.test(document.body.innerText), undefined, { timeout: PATIENCE_MS });
      await page.waitForTimeout(SETTLED_MS);
      await page.screenshot({ path: `${FOLDER}/${size}-${look}-${name}.png` });
      found.push(...(await barriers(page)).map((barrier) => `${name}: ${barrier}`));
    }
    expect(found).toEqual([]);
  });
});
