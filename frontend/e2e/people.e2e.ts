/** Accounts: who may do what, devices that are let go, passkeys. */
import { mkdirSync } from 'node:fs';

import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, barriersInEveryLook, hasBrowser, PATIENCE_MS, sizes, startStage, type Size, type Stage } from './stage';

const PASSWORD = 'correct horse battery';
/** Git ignores it. */
const PICTURES = 'screenshots/people';

const picture = async (page: Page, name: string) => {
  mkdirSync(PICTURES, { recursive: true });
  await page.screenshot({ path: `${PICTURES}/${name}.png` });
};

const writing = (page: Page) => page.getByRole('textbox', { name: /^Write to/ });
const signInTitle = (page: Page) => page.getByRole('heading', { name: 'Sign in' });

async function signIn(stage: Stage, name: string, size: Size, path = ''): Promise<Page> {
  const page = await stage.open(size, path);
  await page.getByLabel('Name').fill(name);
  await page.getByLabel('Password or code').fill(PASSWORD);
  await page.getByRole('button', { name: 'Sign in', exact: true }).click();
  await page.getByRole('button', { name: /^Stop/ }).first().waitFor();
  return page;
}

async function makeAccount(page: Page, name: string, role: string): Promise<void> {
  await page.getByLabel('Name', { exact: true }).fill(name);
  await page.getByLabel('Password', { exact: true }).fill(PASSWORD);
  if (role !== 'Operator') {
    await page.getByRole('button', { name: /^Operator Role$/ }).click();
    await page.getByRole('option', { name: role }).click();
    await page.getByRole('button', { name: `${role} Role`, exact: true }).waitFor();
  }
  await page.getByRole('button', { name: 'Make the account' }).click();
  await page.getByRole('listitem', { name }).waitFor();
}

describe.skipIf(!hasBrowser)('people', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('may do everything until there are accounts, and are told so once', async () => {
    const other = await stage.open(sizes.phone);
    await other.getByText('everybody at this computer may do everything').waitFor();
    await picture(other, 'open-phone');
    expect(await barriers(other)).toEqual([]);
    await other.getByRole('button', { name: 'Understood' }).tap();
    await other.reload();
    await writing(other).waitFor();
    expect(await other.getByText('everybody at this computer').count()).toBe(0);

    const page = await stage.open(sizes.desktop);
    await page.getByRole('link', { name: 'Make accounts' }).click();
    await page.getByRole('heading', { name: 'Make an account' }).waitFor();
    await picture(page, 'first-account');
    expect(await barriers(page)).toEqual([]);
    await page.getByLabel('Name', { exact: true }).fill('Kim');
    await page.getByLabel('Password', { exact: true }).fill(PASSWORD);
    await page.getByRole('button', { name: 'Make the account' }).click();
    await page.getByRole('listitem', { name: 'Kim' }).waitFor();
    await signInTitle(other).waitFor();
    expect(await barriersInEveryLook(other)).toEqual([]);

    await makeAccount(page, 'Ann', 'Operator');
    await makeAccount(page, 'Vic', 'Viewer');
    await picture(page, 'people');
    expect(await barriersInEveryLook(page)).toEqual([]);
    for (const box of ['Remove: Vic', 'New password: Vic']) {
      await page.getByRole('button', { name: box }).click();
      await page.getByRole('heading', { name: box }).waitFor();
      expect(await barriersInEveryLook(page)).toEqual([]);
      await page.keyboard.press('Escape');
    }
    await page.getByRole('button', { name: 'Keep out: Kim' }).click();
    await page.getByText(/last supervisor/).first().waitFor();
  });

  it('who only look have no place to write in, but can stop', async () => {
    const page = await signIn(stage, 'Vic', sizes.phone);
    await page.getByText('You are signed in to look.').waitFor();
    expect(await writing(page).count()).toBe(0);
    await picture(page, 'viewer-phone');
    expect(await barriers(page)).toEqual([]);
    await page.getByRole('button', { name: /^Stop/ }).first().tap();
    await page.getByText(/is stopped and stays so/).waitFor();
    expect(await page.getByRole('button', { name: 'Release…' }).count()).toBe(0);

    const ann = await signIn(stage, 'Ann', sizes.desktop);
    await ann.getByRole('button', { name: 'Release…' }).click();
    await ann.getByRole('button', { name: 'Yes, it is safe' }).click();
    await writing(ann).fill('what can you do?');
    await writing(ann).press('Enter');
    await ann.getByText('Ann', { exact: true }).first().waitFor();
    expect(await ann.getByRole('link', { name: 'People' }).count()).toBe(0);
    await picture(ann, 'operator-desktop');
  });

  it('whose phone is let go are back at the sign-in at once', async () => {
    const phone = await signIn(stage, 'Ann', sizes.phone);
    const kim = await signIn(stage, 'Kim', sizes.desktop, '#/people');
    await kim.getByRole('button', { name: /^Sign out: Ann/ }).first().waitFor();
    await picture(kim, 'devices');
    await kim.getByRole('button', { name: /^Sign out: Ann/ }).last().click();
    await signInTitle(phone).waitFor();
    await picture(phone, 'signed-out-phone');
    expect(await barriers(phone)).toEqual([]);
  });

  it('get another role while they look', async () => {
    const vic = await signIn(stage, 'Vic', sizes.desktop);
    await vic.getByText('You are signed in to look.').waitFor();
    const kim = await signIn(stage, 'Kim', sizes.desktop, '#/people');
    await kim.getByRole('listitem', { name: 'Vic' }).getByRole('button', { name: /Role of Vic$/ }).click();
    await kim.getByRole('option', { name: 'Operator' }).click();
    await writing(vic).waitFor();
  });

  it('sign in with a passkey that they made', async () => {
    const page = await stage.open(sizes.desktop);
    const browser = await page.context().newCDPSession(page);
    await browser.send('WebAuthn.enable');
    await browser.send('WebAuthn.addVirtualAuthenticator', {
      options: {
        protocol: 'ctap2',
        transport: 'internal',
        hasResidentKey: true,
        hasUserVerification: true,
        isUserVerified: true,
        automaticPresenceSimulation: true,
      },
    });
    await page.goto(stage.system.address.replace('127.0.0.1', 'localhost'));
    await page.getByLabel('Name').fill('Ann');
    await page.getByLabel('Password or code').fill(PASSWORD);
    await picture(page, 'sign-in');
    await page.getByRole('button', { name: 'Sign in', exact: true }).click();
    await writing(page).waitFor();
    await page.goto(`${stage.system.address.replace('127.0.0.1', 'localhost')}#/settings`);
    await page.getByLabel('Name of the new passkey').fill('my key');
    await page.getByRole('button', { name: 'Make a passkey' }).click();
    await page.getByText('my key', { exact: true }).waitFor();
    await page.getByRole('heading', { name: 'You', exact: true }).scrollIntoViewIfNeeded();
    await picture(page, 'my-account');
    expect(await barriers(page)).toEqual([]);
    await page.getByRole('button', { name: 'Sign out', exact: true }).click();
    await page.getByRole('button', { name: 'Sign in with a passkey' }).click();
    await page.getByRole('heading', { name: 'You', exact: true }).waitFor();
    const session = await page.evaluate(async () => (await (await fetch('/api/session')).json()) as { name: string });
    expect(session.name).toBe('Ann');
  });

  it('find everything in Estonian too', async () => {
    const page = await stage.open(sizes.phone);
    await page.evaluate(() => localStorage.setItem('parley.prefs', JSON.stringify({ state: { language: 'et' }, version: 1 })));
    await page.reload();
    await page.getByRole('heading', { name: 'Logi sisse' }).waitFor();
    await page.getByLabel('Nimi').fill('Kim');
    await page.getByLabel('Parool või kood').fill(PASSWORD);
    await page.getByRole('button', { name: 'Logi sisse', exact: true }).tap();
    await page.getByRole('textbox', { name: /David/ }).waitFor();
    for (const [path, heading] of [['people', 'Loo konto'], ['settings', 'Sina']] as const) {
      await page.goto(`${stage.system.address}#/${path}`);
      await page.getByRole('heading', { name: heading }).waitFor({ timeout: PATIENCE_MS });
      await picture(page, `${path}-et-phone`);
      expect(await barriers(page)).toEqual([]);
    }
  });
});
