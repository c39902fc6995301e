/** The robot gets stuck, asks, and is helped; then an operator who wants to be asked first. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, say, sizes, startStage, type Stage } from './stage';

describe.skipIf(!hasBrowser)('an operator whose robot needs help', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--speed', '6']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('sees the question highlighted, answers it, and taps the next answer', async () => {
    const page = await stage.open(sizes.tablet);
    await say(page, 'John is on the sofa.');
    await say(page, 'There is a water bottle in the fridge.');
    await page.getByText(/remember/i).nth(1).waitFor();
    await say(page, 'John is thirsty, get him water.');

    const asked = page.locator('li[data-question="open"]');
    await asked.first().waitFor({ timeout: 60_000 });
    await page.getByRole('group', { name: 'How David fares' }).getByText('Waiting for you').waitFor();
    await page.getByText(/^David asks:/).waitFor();
    await say(page, 'I have put it on you.');
    await page.locator('li[data-question="answered"]').first().waitFor();

    await page.getByRole('group', { name: 'Possible answers' }).getByRole('button', { name: /small/i }).tap({ timeout: 60_000 });
    await page.locator('li[data-question="answered"]').nth(1).waitFor();
  });

  it('is asked before a plan begins, takes a step out of it, and begins', async () => {
    const page = await stage.open(sizes.desktop);
    await say(page, 'cancel everything');
    await page.getByRole('button', { name: /When David gets a new task/ }).click();
    await page.getByRole('option', { name: 'Always ask me first' }).click();
    await say(page, 'Go to the dining table, then look at the bed.');
    const proposal = page.getByRole('region', { name: 'David asks: shall I do this?' });
    await proposal.getByRole('button', { name: 'Change' }).click();
    const rows = proposal.getByRole('row');
    const before = await rows.count();
    expect(before).toBeGreaterThan(2);
    await rows.last().getByRole('button', { name: /^Remove/ }).click();
    expect(await rows.count()).toBe(before - 1);
    await page.getByRole('button', { name: 'Undo' }).click();
    expect(await rows.count()).toBe(before);
    await rows.last().getByRole('button', { name: /^Remove/ }).click();
    await proposal.getByRole('button', { name: 'Begin the changed plan' }).click();
    await proposal.waitFor({ state: 'detached' });
    await page.getByRole('region', { name: 'Steps' }).locator('li[data-state]').nth(before - 2).waitFor();
  });
});
