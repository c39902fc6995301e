/** What an operator sees of robots and what they remember: pictures, map, memory, problems. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, untilItMoved, type Stage } from './stage';

describe.skipIf(!hasBrowser)('an operator who looks around', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('sees what the robot sees, as large as the screen, with stopping in reach', async () => {
    const page = await stage.open(sizes.phone, '#/display');
    await page.getByRole('button', { name: 'Enlarge Camera of David' }).tap();
    const large = page.getByRole('dialog', { name: 'Camera of David' });
    const colours = await large.getByRole('img').evaluate((canvas: HTMLCanvasElement) => {
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
      copy?.drawImage(canvas, 0, 0);
      return new Set(new Uint32Array(copy?.getImageData(0, 0, canvas.width, canvas.height).data.buffer ?? new ArrayBuffer(0))).size;
    });
    expect(colours).toBeGreaterThan(20); // an empty one has one
    await large.getByRole('button', { name: /^Stop/ }).waitFor();
    await large.getByRole('button', { name: 'Close' }).tap();
    await large.waitFor({ state: 'detached' });
  });

  it('finds the pictures that were chosen when the page is opened again', async () => {
    const page = await stage.open(sizes.desktop, '#/display');
    await page.getByRole('button', { name: 'Choose' }).click();
    await page.getByRole('checkbox', { name: 'Map' }).check({ force: true });
    await page.reload();
    await page.getByRole('button', { name: 'Enlarge Map of David' }).waitFor();
  });

  it('sees two pictures whole beside a plan', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'Go to the bed.');
    await page.getByRole('heading', { name: 'Plan' }).waitFor();
    await page.getByRole('button', { name: 'Choose' }).click();
    await page.getByRole('checkbox', { name: 'Map' }).check({ force: true });
    await page.keyboard.press('Escape');
    const pictures = page.getByRole('group', { name: 'Pictures' });
    const bottoms = () => pictures.evaluate((group) => [...group.querySelectorAll('canvas')].map((one) => one.getBoundingClientRect().bottom <= group.getBoundingClientRect().bottom));
    await expect.poll(bottoms, { timeout: PATIENCE_MS }).toEqual([true, true]);
  });

  it('is shown what a robot asks while no page is looked at, and not a second time while one is', async () => {
    const context = await stage.browser.newContext({ permissions: ['notifications'] });
    try {
      const page = await context.newPage();
      await page.goto(stage.system.address);
      const told = () =>
        page.evaluate(async () => (await (await navigator.serviceWorker.ready).getNotifications()).map(({ title, body }) => [title, body]));
      expect(await told()).toEqual([]);
      const steering = await context.newCDPSession(page);
      const registered = new Promise<string>((resolve) => {
        steering.on('ServiceWorker.workerRegistrationUpdated', ({ registrations: [first] }) => first && resolve(first.registrationId));
      });
      await steering.send('ServiceWorker.enable');
      const registrationId = await registered;
      const origin = new URL(stage.system.address).origin;
      const push = (body: string) =>
        steering.send('ServiceWorker.deliverPushMessage', { origin, registrationId, data: JSON.stringify({ title: 'Ada', body, tag: body }) });
      await page.goto('about:blank');
      await push('Which one?');
      await page.goto(stage.system.address);
      await expect.poll(told).toEqual([['Ada', 'Which one?']]);
      await push('Shall I?');
      expect(await told()).toEqual([['Ada', 'Which one?']]);
    } finally {
      await context.close();
    }
  });

  it('rests the camera while the page is hidden, and wakes it again', async () => {
    const page = await stage.open(sizes.desktop);
    const sent: string[] = [];
    page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => sent.push(String(payload))));
    await page.goto('about:blank');
    await page.goto(`${stage.system.address}#/display`);
    await page.getByRole('button', { name: 'Enlarge Camera of David' }).waitFor();
    const watched = () => sent.filter((frame) => frame.includes('"watch"')).at(-1) ?? '';
    expect(watched()).toContain('"camera"');
    const turn = (hidden: boolean) =>
      page.evaluate((value) => {
        Object.defineProperty(document, 'hidden', { value, configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
      }, hidden);
    await turn(true);
    await expect.poll(watched).toContain('["watch",[]]');
    await turn(false);
    await expect.poll(watched).toContain('"camera"');
  });

  it('sends the robot to a place on the map', async () => {
    const page = await stage.open(sizes.tablet, '#/map');
    const before = await robotNamed(stage);
    await page.getByRole('application').focus();
    // From the middle of the map to free ground in the living room.
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await page.getByText('Living room', { exact: true }).last().waitFor();
    await page.keyboard.press('Enter'); // the very place in it
    await page.getByText(/^Marked place/).waitFor();
    await page.getByRole('button', { name: 'Go there' }).tap();
    await page.getByText(/^Go to the point \(\d+\.\d\d, \d+\.\d\d\)\.$/).first().waitFor();
    await untilItMoved(stage, before);
    await say(page, 'cancel everything');
  });

  it('points at a thing on the small map beside the chat with a finger', async () => {
    const page = await stage.open(sizes.tablet);
    await page.getByRole('button', { name: 'List' }).tap();
    await page.getByRole('button', { name: 'Pick Bed', exact: true }).tap();
    await page.getByText(/ m, about \d+ s$/).waitFor();
    await page.getByRole('button', { name: 'Mention' }).tap();
    expect(await page.getByRole('textbox', { name: /^Write to/ }).inputValue()).toBe('the bed');
  });

  it('adds, corrects, forgets and takes back a memory', async () => {
    const page = await stage.open(sizes.phone, '#/memory');
    await page.getByRole('button', { name: 'Add' }).tap();
    await page.getByRole('textbox', { name: 'What should be remembered?' }).fill('The door code is blue.');
    await page.getByRole('textbox', { name: 'Short name' }).fill('door_code');
    await page.getByRole('button', { name: 'Save' }).tap();
    await page.getByRole('button', { name: 'Correct “Door code”' }).tap();
    await page.getByRole('textbox', { name: 'What should be remembered?' }).fill('The door code is green.');
    await page.getByRole('button', { name: 'Save' }).tap();
    await page.getByText('The door code is green.').waitFor();
    await page.getByRole('button', { name: 'What “Door code” was before' }).tap();
    await page.getByText('The door code is blue.').waitFor();
    await page.getByRole('button', { name: 'Forget “Door code”' }).tap();
    await page.getByText('The door code is green.').waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Undo' }).tap();
    await page.getByText('The door code is green.').waitFor();
  });

  it('reads what went wrong and finds the moment in the conversation', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'Look for a tennis racket in the wardrobe.');
    await page.locator('li[data-question="open"]').first().waitFor();
    await page.getByRole('link', { name: 'Problems' }).click();
    await page.getByText(/^I looked, but I cannot see the tennis racket/).waitFor();
    await page.getByRole('button', { name: 'See it in the chat' }).first().click();
    await page.locator('li[data-entry]:focus').waitFor();
  });

  it('opens the page without the server, is told so, and finds nothing kept but the page itself', async () => {
    const context = await stage.browser.newContext({ viewport: sizes.phone });
    const page = await context.newPage();
    await page.goto(stage.system.address);
    await page.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));
    const kept = await page.evaluate(async () => {
      const caches = await window.caches.keys();
      const requests = await Promise.all(caches.map(async (name) => (await window.caches.open(name)).keys()));
      return requests.flat().map((request) => new URL(request.url).pathname);
    });
    expect(kept.filter((path) => !/^\/($|icon\.svg$|manifest\.webmanifest$|assets\/)/.test(path))).toEqual([]);
    await context.setOffline(true);
    await page.reload();
    await page.getByText(/^The connection is lost/).waitFor();
    await context.setOffline(false);
    await page.getByText(/^The connection is lost/).waitFor({ state: 'detached' });
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await context.close();
  });
});
