/** Little room, large letters and long names: nothing is cut off, and stopping stays in reach. */
import { chromium, type Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { CHROMIUM, hasBrowser, sizes, startStage, type Stage } from './stage';

const PAGES = ['', 'plan', 'display', 'map', 'memory', 'robots', 'rules', 'incidents', 'log', 'settings'];
const LONG = 'Donaudampfschifffahrtsgesellschaftskapitänsmützenverwahrstelle';
/** Twice what browsers begin with. */
const LARGE = '--blink-settings=defaultFontSize=32';

/** What stands out of the screen at its side, where nobody can scroll to. */
const cutOff = (page: Page) =>
  page.evaluate(() => {
    const wide = document.documentElement.clientWidth;
    const clips = (node: Element | null): boolean =>
      node === null || (/auto|scroll/.test(getComputedStyle(node).overflowX) ? false : clips(node.parentElement));
    return [...document.querySelectorAll('main *, header *')]
      .filter((node) => node.getBoundingClientRect().right > wide + 1 && clips(node) && !node.closest('.hidden, [data-react-aria-prevent-focus]'))
      .map((node) => `${node.tagName}: ${node.textContent}`);
  });

describe.skipIf(!hasBrowser)('on little room', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage([], 'two-robots');
    const body = JSON.stringify({ name: LONG });
    await fetch(`${stage.system.address}api/robots`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body });
  });

  afterAll(async () => {
    await stage.close();
  });

  async function visit(page: Page): Promise<string[]> {
    const found: string[] = [];
    for (const name of PAGES) {
      await page.goto(`${stage.system.address}#/${name}`);
      await page.getByRole('heading', { level: 2 }).first().waitFor({ state: 'attached' });
      if (name === 'robots') await page.getByRole('heading', { name: LONG }).waitFor();
      if (name === 'display') await page.getByRole('img').first().waitFor();
      found.push(...(await cutOff(page)).map((what) => `${name}: ${what}`));
    }
    return found;
  }

  it('nothing is cut off on the smallest phone, in the language with the longest words', async () => {
    const page = await stage.open({ width: 320, height: 568 });
    await page.evaluate(() => localStorage.setItem('parley.prefs', JSON.stringify({ state: { language: 'et' }, version: 1 })));
    await page.reload();
    await page.getByRole('button', { name: 'Peata kõik' }).waitFor();
    expect(await visit(page)).toEqual([]);
  });

  it('a plan of sixty steps is put in order by keys without anything else moving', async () => {
    stage.system.tell('propose David 60');
    const page = await stage.open(sizes.phone, '#/plan');
    await page.getByRole('button', { name: 'Yes, begin' }).waitFor();
    expect(await cutOff(page)).toEqual([]);
    await page.getByRole('button', { name: 'Change' }).click();
    const steps = page.getByRole('grid', { name: 'Change the plan' }).getByRole('row');
    expect(await steps.count()).toBe(60);
    await page.getByRole('button', { name: 'Drag “look at box 0”' }).focus();
    await page.keyboard.press('Enter');
    for (let down = 0; down < 12; down += 1) await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await expect.poll(async () => (await steps.allTextContents()).findIndex((text) => text.includes('box 0'))).toBeGreaterThan(5);
    expect(await page.evaluate(() => document.documentElement.scrollHeight - window.innerHeight)).toBe(0);
    const top = (await page.getByRole('button', { name: 'Stop all' }).boundingBox())?.y ?? -1;
    expect(top).toBeGreaterThanOrEqual(0);
    const save = await page.getByRole('button', { name: 'Begin the changed plan' }).boundingBox();
    expect((save?.y ?? 9999) + (save?.height ?? 0)).toBeLessThan(sizes.phone.height);
  });

  it('nor where the browser is told to write twice as large', async () => {
    const browser = await chromium.launch({ executablePath: CHROMIUM, args: ['--headless', '--no-sandbox', '--disable-gpu', LARGE] });
    try {
      const page = await browser.newPage({ viewport: { width: 414, height: 896 }, serviceWorkers: 'block' });
      await page.goto(stage.system.address);
      const box = page.getByRole('textbox', { name: /^Write to/ });
      await box.waitFor();
      expect(await box.evaluate((line) => Number.parseFloat(getComputedStyle(line).fontSize))).toBeGreaterThanOrEqual(32);
      expect(await visit(page)).toEqual([]);
    } finally {
      await browser.close();
    }
  });
});
