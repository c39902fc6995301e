/** Without a mouse; and photos. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, robotNamed, sizes, startStage, untilItMoved, type Stage } from './stage';

const write = (page: Page) => page.getByRole('textbox', { name: 'Write to David' });

/** Press Tab until what has the keyboard is called so. */
async function tabTo(page: Page, name: RegExp): Promise<void> {
  for (let pressed = 0; pressed < 60; pressed += 1) {
    await page.keyboard.press('Tab');
    const text = await page.evaluate(() => {
      const now = document.activeElement as HTMLElement | null;
      return now?.getAttribute('aria-label') ?? now?.innerText ?? '';
    });
    if (name.test(text)) return;
  }
  throw new Error(`the keyboard never came to ${String(name)}`);
}

describe.skipIf(!hasBrowser)('an operator without a mouse', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('starts the robot, looks around and stops it from within an open box', async () => {
    const page = await stage.open(sizes.desktop);
    await page.getByRole('button', { name: 'Go to the dining table.' }).waitFor();
    const from = await robotNamed(stage);
    await tabTo(page, /^Go to the dining table\.$/);
    await page.keyboard.press('Enter');
    await untilItMoved(stage, from);

    await page.keyboard.press('Control+k');
    const palette = page.getByRole('dialog');
    await palette.getByRole('textbox').waitFor();
    expect(await barriers(page)).toEqual([]);
    await page.keyboard.press('Escape'); // once: closes the box, and stops nobody
    await palette.waitFor({ state: 'detached' });
    await page.keyboard.press('Control+k');
    await palette.getByRole('textbox').waitFor();
    await page.keyboard.press('Escape');
    await palette.waitFor({ state: 'detached' });
    expect((await robotNamed(stage))?.state).not.toBe('stopped');
    await page.keyboard.press('Control+k');
    await palette.getByRole('textbox').waitFor();
    await page.keyboard.type('memory');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'Memory' }).waitFor();

    await page.keyboard.press('?');
    await page.getByRole('dialog', { name: 'Keys' }).waitFor();
    await page.keyboard.press('Escape');
    await page.keyboard.press('Escape');
    await page.getByText('David is stopped and stays so until it is released.').waitFor();
    await page.getByText('Stands still (measured)').waitFor();
    await tabTo(page, /^Release/);
    await page.keyboard.press('Enter');
    await page.getByRole('alertdialog').waitFor();
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await page.getByText('David is stopped').waitFor({ state: 'detached' });
  });

  it('writes several lines, takes the last message again, and finds its half-written words after a look elsewhere', async () => {
    const page = await stage.open(sizes.desktop);
    await write(page).waitFor();
    await page.keyboard.press('/');
    await page.keyboard.type('remember that the tea');
    await page.keyboard.press('Shift+Enter');
    await page.keyboard.type('is on the shelf');
    await page.keyboard.press('Enter');
    await page.locator('li', { hasText: 'remember that the tea' }).first().waitFor();
    await expect.poll(() => write(page).inputValue()).toBe('');
    await page.keyboard.press('ArrowUp');
    await expect.poll(() => write(page).inputValue()).toContain('is on the shelf');
    await write(page).fill('half a sentence');
    await page.goto(`${stage.system.address}#/robots`);
    await page.getByRole('heading', { name: 'Robots' }).waitFor();
    await page.goto(`${stage.system.address}#/`);
    await expect.poll(() => write(page).inputValue()).toBe('half a sentence');
  });

  it('sees times and kinds of messages when it asks for them', async () => {
    const page = await stage.open(sizes.desktop);
    await write(page).waitFor();
    await page.getByRole('button', { name: 'Times and kinds' }).press('Space');
    await page.getByText('REQUEST', { exact: true }).first().waitFor();
    await page.getByText('RESPONSE', { exact: true }).first().waitFor();
    await page.locator('time').first().waitFor();
  });

  it('sends a photo without words, and is asked what it shows', async () => {
    const page = await stage.open(sizes.desktop);
    await write(page).waitFor();
    const photo = await page.screenshot({ type: 'png' });
    const chosen = page.waitForEvent('filechooser');
    await page.getByRole('button', { name: 'Attach a photo' }).press('Enter');
    await (await chosen).setFiles({ name: 'IMG_0001.png', mimeType: 'image/png', buffer: photo });
    await page.getByText('Attached: IMG_0001.png').waitFor();
    await page.getByRole('button', { name: 'Send', exact: true }).press('Enter');
    const shown = page.getByRole('img', { name: 'Attached photo' });
    await shown.waitFor();
    await expect.poll(() => shown.evaluate((image) => (image as HTMLImageElement).naturalWidth)).toBeGreaterThan(0);
    await page.locator('li[data-question="open"]').waitFor();
    await write(page).fill('my desk');
    await write(page).press('Enter');
    await page.locator('li[data-question="answered"]').waitFor();
    const memories = async () => (await stage.get<{ type: string }[]>('memory')).filter((one) => one.type === 'image').length;
    await expect.poll(memories, { timeout: 30_000 }).toBe(1);
  });
});
