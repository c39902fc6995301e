/** What the page does for somebody who never used it, and for somebody who looks away. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, untilItMoved, type Stage } from './stage';

describe.skipIf(!hasBrowser)('somebody new', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--speed', '4']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('gets a robot moving with one tap, and the whole story with two more: the answers', async () => {
    const page = await stage.open(sizes.phone);
    const from = await robotNamed(stage);
    await page.getByRole('button', { name: 'Show me' }).tap();
    await untilItMoved(stage, from);
    await page.getByText(/^Showing/).waitFor({ state: 'detached' });
    expect(await page.getByRole('textbox', { name: 'Write to David' }).inputValue()).toBe('');
    await page.getByRole('button', { name: 'What are you doing?' }).waitFor(); // it fits while a robot works

    const ask = page.getByRole('region', { name: 'David asks' });
    const answer = ask.getByRole('button', { name: 'It is on you' });
    await answer.waitFor();
    const shown = async () => ((await ask.locator('p').boundingBox())?.height ?? 0) > 10;
    await expect.poll(shown, { timeout: PATIENCE_MS }).toBe(false); // it stands in its bubble, right above
    await page.getByRole('region', { name: 'Conversation' }).evaluate((talk) => talk.scrollTo(0, 0));
    await expect.poll(shown, { timeout: PATIENCE_MS }).toBe(true);
    await answer.tap();
    await ask.getByRole('button', { name: 'small sofa' }).tap();
    await page.getByRole('img', { name: 'What David saw' }).scrollIntoViewIfNeeded(); // with "I can see the water bottle"
    await page.getByText(/^I have finished: .*Go to “small sofa”\.$/).waitFor();
    await page.getByRole('group', { name: 'What you may want to say' }).getByRole('button', { name: 'Go to the dining table.' }).waitFor();
  });

  it('reads what was said beside what is asked and written on a phone that lies', async () => {
    const lying = { width: 844, height: 390 };
    const page = await stage.open(lying);
    await say(page, 'Go to the plant.');
    const ask = page.getByRole('region', { name: 'David asks' });
    await ask.getByRole('button', { name: 'plant in the kitchen' }).waitFor();
    const height = async () => (await page.getByRole('region', { name: 'Conversation' }).boundingBox())?.height;
    await expect.poll(height).toBeGreaterThan(lying.height / 2.5);
    const box = await page.getByRole('textbox', { name: 'Write to David' }).boundingBox();
    expect((box?.y ?? Number.NaN) + (box?.height ?? 0)).toBeLessThanOrEqual(lying.height);
    expect(await barriers(page)).toEqual([]);
    await page.setViewportSize({ width: 667, height: 375 });
    await page.getByRole('button', { name: 'Map', exact: true }).tap(); // beside it there is still room to read
    await page.getByRole('application').waitFor();
    await expect.poll(height).toBeGreaterThanOrEqual(120);
    expect(await barriers(page)).toEqual([]);
    await ask.getByRole('button', { name: 'plant in the kitchen' }).tap();
    await page.getByRole('region', { name: 'David asks' }).waitFor({ state: 'detached' });
    await expect.poll(height).toBeGreaterThanOrEqual(120);
  });

  it('hears a robot that waits by title, buzzing and sound, and once more after three minutes', async () => {
    const page = await stage.open(sizes.phone);
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await page.addInitScript(() => {
      const calls: string[] = [];
      const { start } = OscillatorNode.prototype;
      navigator.vibrate = (pattern) => calls.push(`buzz ${pattern.toString()}`) > 0;
      OscillatorNode.prototype.start = function (when) {
        calls.push('sound');
        start.call(this, when);
      };
      Object.assign(window, { calls });
    });
    await page.clock.install();
    await page.goto(`${stage.system.address}#/settings`);
    await page.reload();
    await page.getByText('Let me hear it').tap();
    await page.getByRole('link', { name: 'Chat' }).tap();
    const heard = () => page.evaluate(() => (window as unknown as { calls: string[] }).calls.splice(0));
    await say(page, 'Go to the sofa.');
    await page.getByRole('region', { name: 'David asks' }).waitFor();
    await expect.poll(() => page.title(), { timeout: PATIENCE_MS }).toBe('(1) Parley');
    expect(await heard()).toEqual(['buzz 200,100,200', 'sound']);
    await page.clock.fastForward('03:00');
    await page.getByText('David still waits for you.').waitFor();
    expect(await heard()).toEqual(['buzz 200,100,200', 'sound']);
    await page.getByRole('region', { name: 'David asks' }).getByRole('button', { name: 'small sofa' }).tap();
    await expect.poll(() => page.title(), { timeout: PATIENCE_MS }).toBe('Parley');
    await page.getByText('David still waits for you.').waitFor({ state: 'detached' });
  });

  it('is called on a device whose page is closed, not on one whose page is looked at', async () => {
    const context = await stage.browser.newContext({ viewport: sizes.phone, permissions: ['notifications'] });
    const page = await context.newPage();
    await page.goto(`${stage.system.address}#/settings`);
    await page.evaluate(() => navigator.serviceWorker.ready.then(() => true));
    const worker = context.serviceWorkers()[0];
    const calls = await context.newCDPSession(page);
    const registered = new Promise<string>((settle) => {
      calls.on('ServiceWorker.workerRegistrationUpdated', ({ registrations: [one] }) => one && settle(one.registrationId));
    });
    await calls.send('ServiceWorker.enable');
    const registrationId = await registered;
    const origin = new URL(stage.system.address).origin;
    const call = (title: string) =>
      calls.send('ServiceWorker.deliverPushMessage', { origin, registrationId, data: JSON.stringify({ title, body: 'Which one?', tag: title }) });
    const notes = () => worker?.evaluate(async () => (await (self as unknown as ServiceWorkerGlobal).registration.getNotifications()).map(({ title, body }) => `${title}: ${body}`));
    await call('Ada');
    await page.getByRole('button', { name: 'Call this device' }).click();
    await page.getByText(/^The browser did not allow it, or cannot reach the service/).waitFor(); // there is none here
    await page.goto('about:blank');
    await call('David');
    await expect.poll(notes, { timeout: PATIENCE_MS }).toEqual(['David: Which one?']);
    await context.close();
  });
});

const ROBOTS = ['David', 'Ruth'];

describe.skipIf(!hasBrowser)('somebody new, in the home as it is opened', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage([], 'as-opened');
  });

  afterAll(async () => {
    await stage.close();
  });

  it('finds two robots, sends each somewhere, and stops both with one press', async () => {
    const page = await stage.open(sizes.desktop);
    const tabs = page.getByRole('group', { name: 'Robots you talk to' });
    await page.getByRole('textbox', { name: 'Write to David' }).waitFor();
    await page.getByRole('button', { name: 'Go to the dining table.' }).click();
    await tabs.getByRole('button', { name: /^Ruth/ }).click();
    const [david, ruth] = await Promise.all([robotNamed(stage), robotNamed(stage, 'Ruth')]);
    await say(page, 'Bring me my glasses.');
    await tabs.getByRole('button', { name: 'Ruth is waiting for your answer' }).waitFor();
    await page.getByRole('button', { name: 'Never mind' }).click();
    await say(page, 'Go to the bookshelf.');
    await Promise.all([untilItMoved(stage, david), untilItMoved(stage, ruth)]);
    await page.getByRole('button', { name: 'Stop all' }).click();
    for (const robot of ROBOTS) await page.getByText(`${robot} is stopped and stays so until it is released.`).waitFor();
    await expect.poll(() => page.getByText('Stands still (measured)').count(), { timeout: PATIENCE_MS }).toBe(2);
    for (const robot of ROBOTS) expect((await robotNamed(stage, robot))?.state).toBe('stopped');
  });

  it('releases both, tells both the same, and sees what each says', async () => {
    const page = await stage.open(sizes.phone);
    await page.getByText('Standing still: 2 of 2').waitFor();
    await page.getByRole('button', { name: 'Release all…' }).tap();
    await page.getByRole('button', { name: 'Yes, it is safe' }).tap();
    await page.getByText('2 robots are stopped').waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Several' }).tap();
    await page.getByRole('group', { name: 'Robots you talk to' }).getByRole('button', { name: /^Ruth/ }).tap();
    await page.getByRole('textbox', { name: 'Write to David and Ruth' }).waitFor();
    await page.reload();
    await page.getByRole('textbox', { name: 'Write to David and Ruth' }).waitFor(); // nobody else is written to unawares
    await say(page, 'cancel everything');
    for (const robot of ROBOTS) {
      await expect.poll(async () => (await robotNamed(stage, robot))?.state, { timeout: PATIENCE_MS }).toBe('idle');
    }
    expect(await page.getByText('cancel everything', { exact: true }).count()).toBe(1);
    expect(await barriers(page)).toEqual([]);
  });
});

/** What is used of it; the types of workers do not go together with those of Node.js. */
interface ServiceWorkerGlobal {
  registration: { getNotifications: () => Promise<{ title: string; body: string }[]> };
}
