/** Other devices: encrypted, and only for who has the code. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, sizes, startStage, type Stage } from './stage';

const box = (page: Page) => page.getByRole('textbox', { name: 'Write to David' });

describe.skipIf(!hasBrowser)('a visitor from another device', () => {
  let stage: Stage;
  /** Each code lets one device in; the newest one holds. */
  const code = () => [...stage.system.output().matchAll(/Code to sign in[^:]*: (\S+)/g)].at(-1)?.[1] ?? '';

  beforeAll(async () => {
    stage = await startStage(['--lan']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('is asked for the code, and let in with the right one only', async () => {
    expect(stage.system.address).toMatch(/^https:/);
    const page = await stage.open(sizes.phone);
    await page.getByRole('heading', { name: 'Sign in' }).waitFor();
    expect(await barriers(page)).toEqual([]);
    await page.getByLabel('Password or code').fill('WRONG-CODE');
    await page.getByRole('button', { name: 'Sign in' }).tap();
    await page.getByText('That was not right.').waitFor();
    const first = code();
    await page.getByLabel('Password or code').fill(first.toLowerCase());
    await page.getByLabel('Your name').fill('Mari');
    await page.getByRole('button', { name: 'Sign in' }).tap();
    await box(page).fill('what can you do?');
    await box(page).press('Enter');
    await page.getByText('Mari').first().waitFor();
    await expect.poll(code).not.toBe(first);
    await page.goto(`${stage.system.address}#/settings`);
    await page.getByRole('button', { name: 'Sign out', exact: true }).tap();
    await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  });

  it('needs only a tap where the address brought the code along', async () => {
    const page = await stage.open(sizes.phone, `#code=${code()}`);
    await page.getByRole('button', { name: 'Sign in' }).tap();
    await box(page).waitFor();
    expect(new URL(page.url()).hash).toBe('#/');
  });
});
