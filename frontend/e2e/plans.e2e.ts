/** Plans: asked for, changed before and while they run, refused, stopped. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, beforeEach, describe, expect, it } from 'vitest';

import { distance, hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, steps, untilItMoved, type Stage } from './stage';

const TASK = 'Go to the bed, then look at the wardrobe, then go to the refrigerator.';
const proposal = (page: Page) => page.getByRole('region', { name: 'David asks: shall I do this?' });
/** What would be pressed where a note stands, if that was not there. */
const coveredBy = (text: Element): string[] => {
  const note = text.parentElement;
  const { left, right, top, bottom } = note?.getBoundingClientRect() ?? new DOMRect();
  const across = (from: number, to: number) => Array.from({ length: Math.floor((to - from) / 6) }, (_, at) => from + 3 + 6 * at);
  const there = across(left, right).flatMap((x) => across(top, bottom).flatMap((y) => document.elementsFromPoint(x, y)));
  const pressed = there.map((one) => one.closest('button, a, textarea')).filter((one) => one && !note?.contains(one));
  return [...new Set(pressed)].map((one) => one?.outerHTML.slice(0, 200) ?? '');
};
const names = (page: Page) => page.getByRole('row').locator('span').filter({ hasText: /\w/ }).allInnerTexts();

describe.skipIf(!hasBrowser)('an operator with a plan', () => {
  let stage: Stage;

  const order = async (path: string, body: object, method = 'POST') => {
    const headers = { 'Content-Type': 'application/json' };
    const answer = await fetch(`${stage.system.address}api/plans/David/${path}`, { method, headers, body: JSON.stringify(body) });
    expect(answer.status).toBe(200);
  };
  const policy = (chosen: string) => order('policy', { policy: chosen }, 'PUT');

  beforeAll(async () => {
    stage = await startStage();
  });

  beforeEach(async () => {
    await expect.poll(async () => (await robotNamed(stage))?.name, { timeout: PATIENCE_MS }).toBe('David');
    await order('command', { command: 'clear' });
  });

  afterAll(async () => {
    await stage.close();
  });

  it('says no, and nothing moves', async () => {
    await policy('ask_first');
    const page = await stage.open(sizes.phone);
    const from = await robotNamed(stage);
    await say(page, 'Go to the bed.');
    await page.getByRole('link', { name: /shall I do this/ }).tap();
    await proposal(page).getByRole('button', { name: 'No', exact: true }).tap();
    await proposal(page).waitFor({ state: 'detached' });
    const now = await robotNamed(stage);
    expect(now?.state).toBe('idle');
    expect(distance(now, from)).toBeLessThan(0.1);
  });

  it('says yes, and it begins', async () => {
    await policy('ask_first');
    const page = await stage.open(sizes.tablet);
    const from = await robotNamed(stage);
    await say(page, 'Go to the bed.');
    await proposal(page).getByRole('button', { name: 'Yes, begin' }).tap();
    await untilItMoved(stage, from);
  });

  it('puts steps in another order with keys and by dragging, before it begins', async () => {
    await policy('ask_first');
    const page = await stage.open(sizes.desktop);
    await say(page, TASK);
    await proposal(page).getByRole('button', { name: 'Change' }).press('Enter');
    const rows = proposal(page).getByRole('row');
    await rows.nth(3).waitFor();
    const before = await names(page);
    const last = rows.last();
    await last.focus(); // a list that is entered from elsewhere takes the keyboard to its row
    await last.getByRole('button', { name: /^Move .* up$/ }).press('Enter');
    await expect.poll(() => names(page), { timeout: PATIENCE_MS }).not.toEqual(before);
    const moved = await names(page);
    expect([...moved].sort()).toEqual([...before].sort());

    const dragged = (await names(page))[0];
    await rows.first().locator('span').first().dragTo(rows.nth(2), { targetPosition: { x: 60, y: 40 } });
    await expect.poll(async () => (await names(page))[0], { timeout: PATIENCE_MS }).not.toBe(dragged);

    await rows.first().getByRole('button', { name: 'On the map' }).click();
    const picker = page.getByRole('dialog', { name: 'Place' });
    await picker.locator('svg image').click({ position: { x: 60, y: 60 } });
    await picker.getByText('Kitchen', { exact: true }).waitFor();
    await picker.getByRole('button', { name: 'Use this place' }).click();
    await expect.poll(async () => (await names(page))[0], { timeout: PATIENCE_MS }).toContain('“kitchen”');
    await proposal(page).getByRole('button', { name: 'Cancel' }).click();
    await proposal(page).getByRole('button', { name: 'No', exact: true }).click();
    await proposal(page).waitFor({ state: 'detached' });
  });

  it('takes one step out of a running plan, puts it back, and changes what is left', async () => {
    await policy('run_at_once');
    const page = await stage.open(sizes.desktop);
    await say(page, TASK);
    await steps(page).locator('li[data-state="running"]').waitFor();
    await say(page, 'pause');
    const queued = steps(page).locator('li[data-state="queued"]');
    await page.getByText('Paused', { exact: true }).first().waitFor();
    const count = await queued.count();
    expect(count).toBeGreaterThan(2);
    await queued.last().getByRole('button', { name: /^Remove/ }).click();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(count - 1);
    await page.getByRole('button', { name: 'Undo' }).click();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(count);

    await page.getByRole('button', { name: 'Change', exact: true }).dblclick(); // once more than needed: nothing else is pressed
    await page.getByRole('button', { name: /Add a step/ }).click();
    await page.getByRole('option', { name: 'Look with the camera: …' }).click();
    await page.getByRole('button', { name: 'Save' }).click();
    const notes = page.getByRole('region', { name: 'Notes' });
    const impossible = notes.getByText(/^I cannot do step 5, “Look with the camera: …”: something that it needs is not given/); // as numbered there
    await impossible.waitFor();
    expect(await impossible.evaluate(coveredBy), 'what lies under the note').toEqual([]);
    expect(await notes.getByText('The plan was changed.').count()).toBe(0);
    for (let dropped = 0; dropped < 2; dropped += 1) await page.getByRole('row').last().getByRole('button', { name: /^Remove/ }).click();
    await page.getByRole('button', { name: 'Save' }).click();
    await page.getByText('The plan was changed.').first().waitFor();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(count - 1);

    await page.getByRole('button', { name: 'Cancel all' }).click();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(0);
    await page.getByText(/were cancelled/).waitFor();
    await page.getByRole('button', { name: 'Begin again' }).click();
    const running = steps(page).locator('li[data-state="running"]');
    await running.getByText('Go to “bed”').waitFor();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(count - 1);
    const shown = () => steps(page).locator('li[data-state]').evaluateAll((all) => all.map((one) => `${one.getAttribute('data-state')}: ${one.querySelector('button')?.textContent}`));
    const before = await shown();
    await page.getByRole('button', { name: 'Skip', exact: true }).click();
    await notes.getByText('“Go to ‘bed’” is left out.').waitFor();
    await expect.poll(shown, { timeout: PATIENCE_MS }).not.toEqual(before);
    await running.waitFor(); // what comes next has begun
    await notes.getByRole('button', { name: 'Undo' }).click();
    await expect.poll(shown, { timeout: PATIENCE_MS }).toEqual(before);
    expect(await page.getByText('I could not do that').count()).toBe(0);
    const { rounds } = await stage.get<{ rounds: { words: string; state: string }[] }>('history');
    expect(rounds.filter(({ words }) => words === TASK).map(({ state }) => state)).toEqual(['running']); // it was one order
  });

  it('presses twice in a hurry, or at once with somebody else, and does it once', async () => {
    await policy('run_at_once');
    const [one, two] = await Promise.all([stage.open(sizes.desktop), stage.open(sizes.phone)]);
    await say(one, 'Go to the sofa.');
    await two.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: 'large sofa' }).dblclick();
    await steps(one).locator('li[data-state="running"]').waitFor();
    expect(await one.getByText('large sofa', { exact: true }).and(one.locator('li[data-mine="true"] p')).count()).toBe(1);
    expect(await two.getByRole('button', { name: 'Send again', exact: true }).count()).toBe(0);

    await say(one, 'Then go to the bed, then to the wardrobe, then to the refrigerator.');
    await expect.poll(() => steps(one).locator('li[data-state="queued"]').count(), { timeout: PATIENCE_MS }).toBe(3);
    type Steps = { planned: string; state: string; only_finds: boolean }[];
    const planned = async () => (await stage.get<{ kind: string; steps: Steps }[]>('plans/David')).find(({ kind }) => kind === 'plan')?.steps ?? [];
    const skipped = async () => (await planned()).filter(({ state }) => state === 'skipped').length;
    const over = one.getByText('That step is over by now, so there was nothing to leave out.');
    await one.getByRole('button', { name: 'Skip', exact: true }).dblclick();
    await steps(one).locator('li[data-state="running"]').getByText('Go to “bed”').waitFor();
    expect([await skipped(), await over.count()]).toEqual([1, 0]);

    // Not the search for its place, which is over in no time.
    const driving = async () => (await planned()).find((one) => one.state === 'running' && !one.only_finds)?.planned;
    await expect.poll(driving, { timeout: PATIENCE_MS }).toBeTruthy();
    const step = await driving();
    const skip = () => order('command', { command: 'skip', step }); // of two people, one a moment later
    await skip();
    await expect.poll(skipped, { timeout: PATIENCE_MS }).toBe(2);
    await skip();
    await over.first().waitFor();
    expect(await skipped()).toBe(2);
  });

  it('keeps what one changed when somebody else changed the plan meanwhile', async () => {
    await policy('run_at_once');
    const [one, two] = await Promise.all([stage.open(sizes.desktop), stage.open(sizes.desktop)]);
    await say(one, TASK);
    await steps(one).locator('li[data-state="running"]').waitFor();
    await say(one, 'pause');
    await two.getByText('Paused', { exact: true }).first().waitFor();
    const queued = steps(two).locator('li[data-state="queued"]');
    const count = await queued.count();
    await one.getByRole('button', { name: 'Change', exact: true }).click();
    await one.getByRole('row').first().getByRole('button', { name: /^Remove/ }).click();
    await queued.last().getByRole('button', { name: /^Remove/ }).click();
    await one.getByText(/What you changed is kept, in the newest plan/).waitFor();
    await expect.poll(() => one.getByRole('grid', { name: 'Change the plan' }).getByRole('row').count(), { timeout: PATIENCE_MS }).toBe(count - 2);
    await one.getByRole('button', { name: 'Save' }).click();
    await expect.poll(() => queued.count(), { timeout: PATIENCE_MS }).toBe(count - 2);
  });

  it('keeps what is being changed while the server is killed, and drops no step that waits again', async () => {
    await policy('run_at_once');
    const page = await stage.open(sizes.desktop);
    await say(page, 'cancel everything');
    await say(page, TASK);
    await steps(page).locator('li[data-state="running"]').waitFor();
    await page.getByRole('button', { name: 'Pause', exact: true }).click();
    const paused = steps(page).locator('li[data-state="paused"]');
    const interrupted = (await paused.getByRole('button').first().textContent())?.split('”')[0] ?? '?';
    await page.getByRole('button', { name: 'Change', exact: true }).click();
    const rows = page.getByRole('row');
    const count = await rows.count();
    await rows.first().getByRole('button', { name: /^Remove/ }).click();
    await stage.system.kill();
    await page.getByText(/^The connection is lost/).waitFor();
    await stage.system.start();
    await steps(page).locator('li[data-state="queued"]').filter({ hasText: interrupted }).waitFor();
    expect(await rows.count()).toBe(count - 1);
    await page.getByRole('button', { name: 'Save' }).click();
    await page.getByText('The plan was changed.').first().waitFor();
    await expect.poll(() => steps(page).locator('li[data-state="queued"]').count(), { timeout: PATIENCE_MS }).toBe(count);
    await page.getByRole('button', { name: 'Continue' }).click();
    await steps(page).locator('li[data-state="running"]').waitFor();
    const { rounds } = await stage.get<{ rounds: { words: string; state: string }[] }>('history');
    expect(rounds.filter(({ state }) => state === 'running' || state === 'unrecorded').map(({ words }) => words)).toEqual([TASK]); // nor two of it
  });

  it('stops it while it drives, and lets it carry on afterwards', async () => {
    await policy('run_at_once');
    const page = await stage.open(sizes.tablet);
    const from = await robotNamed(stage);
    await say(page, 'Go to the refrigerator.');
    await untilItMoved(stage, from);
    await page.getByRole('button', { name: 'Stop', exact: true }).tap();
    await page.getByText('Stands still (measured)').waitFor();
    const stood = await robotNamed(stage);
    await page.getByRole('button', { name: 'Continue' }).tap();
    const note = page.getByRole('region', { name: 'Notes' }).getByText('David does not move until its emergency stop is released.');
    await note.waitFor();
    await page.setViewportSize(sizes.phone);
    await page.getByRole('navigation', { name: 'Pages at hand' }).waitFor();
    expect(await note.evaluate(coveredBy), 'what lies under the note').toEqual([]);
    await page.setViewportSize(sizes.tablet);
    await page.getByRole('button', { name: 'Release…' }).tap();
    await page.getByRole('button', { name: 'Yes, it is safe' }).tap();
    await page.getByText('David is stopped').waitFor({ state: 'detached' });
    await note.waitFor({ state: 'detached' }); // it is not true any more
    expect(distance(await robotNamed(stage), stood)).toBeLessThan(0.25);
    await page.getByRole('button', { name: 'Continue' }).tap();
    await untilItMoved(stage, stood);
  });
});
