/** Nothing keeps people from using any page or box, in any size, look or language (axe, WCAG 2.2 AA and good practice). */
import { readFileSync } from 'node:fs';

import type { Locator, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, say, sizes, startStage, type Rules, type Stage } from './stage';

const pages = ['', 'plan', 'display', 'map', 'memory', 'robots', 'rules', 'incidents', 'log', 'people', 'settings'] as const;
/** Looks change colours and nothing else, and another language all but colours. */
const faces = [
  ['light', 'en', 'all'],
  ['dark', 'en', 'colours'],
  ['contrast', 'en', 'colours'],
  ['forced', 'en', 'colours'],
  ['light', 'et', 'all else'],
] as const;
/**
 * Looks at a page of each size and face, all sizes at once: each is drawn by a process of its own. What a tablet shows has
 * the colours and words of the other sizes.
 */
async function inEach(stage: Stage, look: (page: Page, findings: Findings, words: Words) => Promise<void>): Promise<string[]> {
  const of = async (size: keyof typeof sizes) => {
    const found: string[] = [];
    for (const [theme, language, rules] of size === 'tablet' ? faces.slice(0, 1) : faces) {
      const page = await dressed(stage, size, theme, language);
      const findings = new Findings(page, rules);
      await look(page, findings, wordsIn(language));
      found.push(...findings.all.map((barrier) => `${size} ${theme} ${language}: ${barrier}`));
      await page.context().close();
    }
    return found;
  };
  return (await Promise.all((Object.keys(sizes) as (keyof typeof sizes)[]).map(of))).flat();
}

type Words = (file: string, key: string) => string;

const wordsIn = (language: string): Words => (file, key) => {
  const words = JSON.parse(readFileSync(`src/i18n/${language}/${file}.json`, 'utf8')) as unknown;
  const found = key.split('.').reduce((part, name) => (part as Record<string, unknown> | undefined)?.[name], words);
  if (typeof found !== 'string') throw new Error(`there is no ${file}:${key}`);
  return found.replace('{{robot}}', 'David').replace('{{name}}', 'David');
};

/** A page in a look and a language; `forced`: in the colours of the device, which chooses dark ones. */
async function dressed(stage: Stage, size: keyof typeof sizes, theme: string, language: string): Promise<Page> {
  const isForced = theme === 'forced';
  const prefs = JSON.stringify({ state: { theme: isForced ? 'dark' : theme, language, debug: true, welcomed: true }, version: 1 });
  const page = await stage.open(sizes[size], '', false, prefs);
  if (isForced) await page.emulateMedia({ forcedColors: 'active', colorScheme: 'dark' });
  await page.getByRole('heading', { level: 2 }).first().waitFor();
  return page;
}

async function go(stage: Stage, page: Page, path: string): Promise<void> {
  await page.goto(`${stage.system.address}#/${path}`);
  await page.getByRole('heading', { level: 2 }).first().waitFor();
}

const post = (stage: Stage, path: string, body: object) =>
  fetch(`${stage.system.address}api/${path}`, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify(body),
  });

/** Whether something else lies over the lower edge of what is on the page. */
const covered = (what: Locator): Promise<boolean> =>
  what.evaluate((element) => {
    const box = element.getBoundingClientRect();
    const top = document.elementFromPoint(box.left + box.width / 2, box.bottom - 3);
    return top !== element;
  });

/** Collects what is found, by where. */
class Findings {
  readonly all: string[] = [];
  constructor(
    private readonly page: Page,
    private readonly rules: Rules,
  ) {}

  async look(where: string, there?: Locator): Promise<void> {
    await there?.first().waitFor();
    this.all.push(...(await barriers(this.page, this.rules)).map((barrier) => `${where}: ${barrier}`));
  }
}

describe.skipIf(!hasBrowser)('nobody meets a barrier', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage(['--ask-first', '--speed', '6']);
  });

  afterAll(async () => {
    await stage.close();
  });

  it('where a plan waits for a yes and is changed', async () => {
    const first = await stage.open(sizes.desktop);
    await say(first, 'John is on the sofa.');
    await first.getByText('I will remember that John').waitFor();
    await say(first, 'go to John, then go to the TV');
    await first.getByRole('heading', { name: 'David asks: shall I do this?' }).waitFor();
    const found = await inEach(stage, async (page, findings, words) => {
      await go(stage, page, 'plan');
      await findings.look('proposal', page.getByRole('button', { name: words('plan', 'approve_other').split(' {')[0] ?? '' }));
      await page.getByRole('button', { name: words('plan', 'change'), exact: true }).first().click();
      const last = page.getByRole('grid').getByRole('button', { name: words('plan', 'place') }).last();
      await last.focus();
      expect(await covered(last), 'what has the keyboard is in sight').toBe(false);
      await last.evaluate((choice) => choice.scrollIntoView({ block: 'center' })); // not half behind the buttons
      await findings.look('changing it', page.getByText(words('plan', 'editHelp')));
      await page.getByRole('button', { name: words('plan', 'onMap') }).last().click();
      await findings.look('a place on the map', page.getByRole('dialog').locator('svg image'));
      await page.keyboard.press('Escape');
      await go(stage, page, '');
      await findings.look('chat beside it');
    });
    expect(found).toEqual([]);
  }, 300_000);

  it('on any page, while a robot asks', async () => {
    const [waiting] = (await stage.get<{ proposals: { id: string; digest: string }[] }>('snapshot')).proposals;
    const yes = { id: waiting?.id, digest: waiting?.digest, decision: 'approve' };
    expect((await post(stage, 'plans/David/decision', yes)).status).toBe(200);
    const first = await stage.open(sizes.desktop);
    await first.getByText(/^David asks:/).waitFor();
    const found = await inEach(stage, async (page, findings) => {
      for (const path of pages) {
        await go(stage, page, path);
        await findings.look(path || 'chat');
      }
    });
    expect(found).toEqual([]);
  }, 600_000);

  it('in any box', async () => {
    expect(await inEach(stage, (page, findings, words) => boxes(stage, page, words, findings))).toEqual([]);
  }, 300_000);

  it('while robots are stopped and when they are released', async () => {
    await post(stage, 'stop', { command: 'stop', targets: [], id: crypto.randomUUID() });
    const found = await inEach(stage, async (page, findings, words) => {
      await findings.look('stopped', page.getByText(words('stop', 'banner')));
      await page.getByRole('button', { name: words('stop', 'reset') }).click();
      await findings.look('releasing', page.getByRole('alertdialog'));
    });
    expect(found).toEqual([]);
  }, 300_000);
});

async function boxes(stage: Stage, page: Page, words: Words, findings: Findings): Promise<void> {
  const box = page.getByRole('dialog');
  const close = async () => {
    await page.keyboard.press('Escape');
    await box.waitFor({ state: 'detached' });
  };
  await page.getByRole('textbox').first().waitFor();
  const menu = page.getByRole('button', { name: words('menu', 'menu'), exact: true });
  if (await menu.isVisible()) {
    await menu.click();
    await findings.look('menu', box);
    await close();
  }
  await page.keyboard.press('Control+k');
  await findings.look('quick actions', box.getByRole('textbox'));
  await close();
  await page.getByText('David', { exact: true }).first().click(); // keys count where nobody writes
  await page.keyboard.press('?');
  await findings.look('keys', box);
  await close();
  await go(stage, page, 'robots');
  await page.getByRole('button', { name: words('robots', 'add') }).click();
  await findings.look('add a robot', box);
  await close();
  await go(stage, page, 'log');
  for (const part of ['handover', 'log', 'rounds']) {
    await page.getByRole('button', { name: words('log', `parts.${part}`) }).click();
    await findings.look(part, page.getByText(/\d\d:\d\d/));
  }
  await go(stage, page, 'rules');
  await page.getByRole('button', { name: words('rules', 'add') }).click();
  await findings.look('making a rule', page.getByRole('button', { name: words('rules', 'save') }));
  await go(stage, page, '');
  await page.getByRole('button', { name: words('favourites', 'title') }).click();
  await findings.look('favourites', box);
  await close();
  const chosen = page.waitForEvent('filechooser');
  await page.getByRole('button', { name: words('chat', 'attach') }).click();
  const photo = { name: 'box.png', mimeType: 'image/png', buffer: await page.screenshot({ type: 'png' }) };
  await (await chosen).setFiles(photo);
  await findings.look('a photo', page.getByText('box.png'));
  await page.getByRole('button', { name: words('chat', 'search') }).click();
  await page.getByRole('search').getByRole('textbox').fill('John');
  await findings.look('search', page.getByRole('search').getByRole('button').nth(1));
  await go(stage, page, 'memory');
  await page.getByRole('button', { name: words('memory', 'add'), exact: true }).click();
  await findings.look('remember something', box);
  await close();
  await go(stage, page, 'display');
  await page.getByRole('button', { name: words('display', 'choose') }).click();
  await findings.look('choosing pictures', box);
  await close();
  await page.getByRole('img').first().click();
  await findings.look('a large picture', box);
  await close();
  await go(stage, page, 'map');
  await page.getByRole('button', { name: words('map', 'asList') }).click();
  await findings.look('the map as a list', page.getByRole('region', { name: words('map', 'list') }));
}
