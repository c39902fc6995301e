/** The server goes away and comes back, in order and not. */
import { randomUUID } from 'node:crypto';
import { setTimeout as pause } from 'node:timers/promises';

import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, type Stage } from './stage';

/** `make soak` asks for more. */
const KILLS = Number(process.env.PARLEY_KILLS ?? 3);
/** How many entries the page draws until more are asked for. */
const DRAWN = 60;
const SEED = Number(process.env.PARLEY_SEED ?? 7);

/** Numbers from 0 to 1, the same ones for the same seed. */
function* numbers(seed: number): Generator<number, never> {
  for (let state = seed; ; ) {
    state = (state * 48271) % 2147483647;
    yield state / 2147483647;
  }
}

interface Said {
  id: string;
  message: string;
}

describe.skipIf(!hasBrowser)('a page whose server goes away', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  const shown = (page: Page) => page.locator('ol > li[data-type] > div:first-of-type > p').allTextContents();
  const log = async () => (await stage.get<{ entries: Said[] }>('chat?limit=500')).entries.map((one) => one.message);

  it('says so, keeps what is written meanwhile, and sends it on a tap', async () => {
    const page = await stage.open(sizes.tablet);
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await stage.system.kill();
    await page.getByText(/The connection is lost since/).waitFor();
    await say(page, 'what can you do?');
    await page.getByText(/^Not sent/).waitFor();
    await stage.system.start();
    await page.getByRole('button', { name: 'Connect now' }).tap({ timeout: 3000 }).catch(() => undefined);
    await page.getByText(/The connection is lost since/).waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Send again', exact: true }).tap();
    await page.getByText(/^Not sent/).waitFor({ state: 'detached' });
    await page.getByText(/I can /).first().waitFor();
    expect((await log()).filter((message) => message === 'what can you do?')).toHaveLength(1);
  });

  it('stops on the line that is kept open where no request gets through any more', async () => {
    const page = await stage.open(sizes.tablet);
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await page.route('**/api/stop', (route) => route.abort());
    await page.getByRole('button', { name: 'Stop', exact: true }).tap();
    await page.getByText('Stands still (measured)').waitFor();
    await page.unroute('**/api/stop');
    await page.getByRole('button', { name: 'Release…' }).tap();
    await page.getByRole('button', { name: 'Yes, it is safe' }).tap();
    await page.getByText('David is stopped').waitFor({ state: 'detached' });
  });

  it('says at once that a stop cannot be sent, and stops the robot when the server is back', async () => {
    const page = await stage.open(sizes.tablet);
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await stage.system.kill();
    await page.getByText(/The connection is lost since/).waitFor();
    await page.getByRole('button', { name: 'Stop', exact: true }).tap();
    await page.getByText(/^Not connected: the stop has not got through!/).waitFor({ timeout: 1000 });
    await stage.system.start();
    await page.getByText('Stands still (measured)').waitFor();
    await page.getByText(/^Not connected: the stop has not got through!/).waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Release…' }).tap();
    await page.getByRole('button', { name: 'Yes, it is safe' }).tap();
    await page.getByText('David is stopped').waitFor({ state: 'detached' });
    await stage.system.kill();
    await page.getByRole('button', { name: 'Stop', exact: true }).tap();
    await page.getByRole('button', { name: 'Call it off' }).tap();
    const written = page.locator('li[data-mine="true"]').filter({ hasText: 'stop, please' });
    await say(page, 'stop, please');
    await written.getByText(/^Not connected: the stop has not got through!/).waitFor({ timeout: 1500 });
    await stage.system.start();
    await page.getByText(/The connection is lost since/).waitFor({ state: 'detached' });
    await written.getByText(/^Not connected/).waitFor({ state: 'detached' });
    expect((await log()).filter((message) => message === 'stop, please')).toHaveLength(1);
    await expect.poll(async () => (await robotNamed(stage))?.state, { timeout: PATIENCE_MS }).toBe('idle');
  });

  it('keeps the map that was seen last, with its age, and renews it', async () => {
    const page = await stage.open(sizes.tablet, '#/map');
    const map = page.getByRole('application');
    await map.waitFor();
    await stage.system.kill();
    await page.getByText(/^Not connected. This is how it was/).waitFor();
    await page.goto(`${stage.system.address}#/settings`);
    await page.getByRole('heading', { name: 'Settings' }).waitFor();
    await page.goto(`${stage.system.address}#/map`);
    await page.getByText(/^Not connected. This is how it was/).waitFor();
    await map.waitFor();
    await stage.system.start();
    await page.getByText(/^Not connected. This is how it was/).waitFor({ state: 'detached' });
    await map.waitFor();
    expect(await page.getByText('There is no map yet.').count()).toBe(0);
  });

  it(`shows what the server kept after ${KILLS} kills at any moment`, { timeout: 60_000 + KILLS * 40_000 }, async () => {
    const page = await stage.open(sizes.desktop);
    const random = numbers(SEED);
    let count = 0;
    for (let kill = 0; kill < KILLS; kill += 1) {
      await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
      const killed = pause(random.next().value * 1500).then(() => stage.system.kill());
      const messages = 1 + Math.floor(random.next().value * 4);
      for (let said = 0; said < messages; said += 1) {
        count += 1;
        await say(page, `remember that box ${count} is red`);
      }
      await killed;
      await stage.system.start();
      await page.getByText(/The connection is lost since/).waitFor({ state: 'detached' });
      const again = page.getByRole('button', { name: 'Send again', exact: true });
      await page.getByText('Sending…', { exact: true }).first().waitFor({ state: 'detached' });
      while ((await again.count()) > 0) {
        await again.first().click();
        await page.getByText('Sending…', { exact: true }).first().waitFor({ state: 'detached' });
      }
      // Replies to what was sent last may still be under way: compare until both are the same.
      const same = async () => JSON.stringify(await shown(page)) === JSON.stringify((await log()).slice(-DRAWN));
      await expect.poll(same, { timeout: PATIENCE_MS, interval: 250 }).toBe(true);
    }
    const boxes = (await log()).filter((message) => message.startsWith('remember that box'));
    const heard = boxes.map((message) => Number(/\d+/.exec(message)?.[0])).sort((a, b) => a - b);
    expect(heard).toEqual(Array.from({ length: count }, (_, at) => at + 1));
  });

  it('shows a long conversation from its newest end, and the rest when asked', async () => {
    const total = 130;
    const before = (await log()).length;
    const answered = (lines: number) => expect.poll(async () => (await log()).length, { timeout: PATIENCE_MS, interval: 500 }).toBeGreaterThanOrEqual(before + 2 * lines);
    for (let at = 0; at < total; at += 1) {
      if (at === total - 1) await answered(at); // on a busy machine replies come late, and the newest end held nothing else
      const body = JSON.stringify({ id: randomUUID(), text: `line ${at}: stop`, targets: ['David'] });
      const post = () => fetch(`${stage.system.address}api/chat`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body });
      let answer = await post();
      while (answer.status === 429) {
        await pause(1000 * Number(answer.headers.get('retry-after') ?? 1));
        answer = await post();
      }
      expect(answer.status).toBe(200);
    }
    await answered(total);
    const page = await stage.open(sizes.phone);
    await page.getByText(`line ${total - 1}: stop`, { exact: true }).waitFor();
    expect(await page.getByText('line 0: stop', { exact: true }).count()).toBe(0);
    const fromEnd = () => page.getByRole('region', { name: 'Conversation' }).evaluate((box) => box.scrollHeight - box.scrollTop - box.clientHeight);
    for (const turned of [{ width: 844, height: 390 }, sizes.phone]) {
      await page.setViewportSize(turned);
      await expect.poll(fromEnd, { timeout: PATIENCE_MS }).toBeLessThan(2);
      expect(await page.getByRole('button', { name: 'Newest messages' }).count()).toBe(0);
    }
    const older = page.getByRole('button', { name: 'Show earlier messages' });
    const beginning = page.getByText('This is where the conversation begins.');
    while (!(await beginning.isVisible())) {
      const so = (await shown(page)).length;
      await older.tap();
      await expect.poll(async () => (await beginning.isVisible()) || (await shown(page)).length > so, { timeout: PATIENCE_MS }).toBe(true);
    }
    expect(await shown(page)).toEqual(await log());
  });
});
