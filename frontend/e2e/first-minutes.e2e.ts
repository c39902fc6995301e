/** What the page does for somebody who never used it. */
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { hasBrowser, say, sizes, startStage, type Stage } from './stage';

describe.skipIf(!hasBrowser)('somebody new', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('is shown the story by the page, which writes it; the answers are left to them', async () => {
    const page = await stage.open(sizes.phone);
    await page.getByRole('button', { name: 'Show me' }).tap();
    await page.getByText('I will remember that there is a water bottle').waitFor();
    await page.getByText('John is thirsty, get him water.', { exact: true }).waitFor();
    await page.getByText(/^Showing/).waitFor({ state: 'detached' });
    const box = page.getByRole('textbox', { name: 'Write to David' });
    expect(await box.inputValue()).toBe('');
    await page.getByRole('button', { name: 'What are you doing?' }).tap(); // it fits while a robot works
    await page.locator('li[data-mine="true"]').last().getByText('What are you doing?').waitFor();
    await say(page, 'cancel everything');
    await page.getByRole('group', { name: 'What you may want to say' }).getByRole('button', { name: 'Go to the dining table.' }).waitFor();
  });
});
