/** A third language needs its files only, and neither sources nor a build. */
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, say, sizes, startStage, type Stage } from './stage';

type Words = { [key: string]: string | Words };
/** Told apart from English at a glance, and longer, as most languages are. */
const other = (text: string) => `«${text}» āā`;
const inOther = (words: Words): Words =>
  Object.fromEntries(Object.entries(words).map(([key, value]) => [key, typeof value === 'string' ? other(value) : inOther(value)]));

/** A folder with Latvian, of a sort: one file for the page, one for what robots say. */
function latvian(): string {
  const folder = mkdtempSync(join(tmpdir(), 'parley-languages-'));
  const parts = readdirSync('src/i18n/en').filter((file) => file.endsWith('.json'));
  const words = parts.map((file) => [file.replace('.json', ''), inOther(JSON.parse(readFileSync(`src/i18n/en/${file}`, 'utf8')) as Words)]);
  writeFileSync(join(folder, 'lv.json'), JSON.stringify(Object.fromEntries(words)));
  const sentences = readFileSync('../src/parley/sentences/et.yaml', 'utf8').matchAll(/^- en: (".*")$/gm);
  const pairs = [...sentences].map(([, text = '""']) => `- en: ${text}\n  lv: ${JSON.stringify(other(JSON.parse(text) as string))}`);
  writeFileSync(join(folder, 'lv.yaml'), pairs.join('\n'));
  return folder;
}

describe.skipIf(!hasBrowser)('a third language', () => {
  let folder = '';
  let stage: Stage;

  beforeAll(async () => {
    folder = latvian();
    process.env.PARLEY_LANGUAGES = folder;
    stage = await startStage(['--ask-first']);
  });

  afterAll(async () => {
    delete process.env.PARLEY_LANGUAGES;
    await stage.close();
    rmSync(folder, { recursive: true, force: true });
  });

  it('is offered, read on the page and said by robots, with nothing but its files', async () => {
    const page = await stage.open(sizes.desktop, '#/settings');
    await page.getByRole('button', { name: /Language/ }).click();
    await page.getByRole('option', { name: 'Latviešu' }).click();
    await page.getByRole('heading', { level: 2, name: other('Settings') }).waitFor();
    expect(await page.evaluate(() => document.documentElement.lang)).toBe('lv');
    await page.getByRole('link', { name: other('Chat') }).click();
    const box = page.getByRole('textbox', { name: other('Write to David') });
    await box.fill('go to the fridge');
    await box.press('Enter');
    await page.getByText(/«This is what I would do: .*» āā «Shall I\?» āā/).waitFor();
    await page.getByText(/^«Go to .*“refrigerator in the kitchen”.*» āā$/).first().waitFor();
    expect(await barriers(page)).toEqual([]);

    const english = await stage.open(sizes.phone);
    await english.getByText(/^This is what I would do: .* Shall I\?$/).first().waitFor();
    await say(english, 'no');
    await page.getByText(other('All right, I will not do it.')).waitFor();
  });
});
