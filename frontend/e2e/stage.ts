/** Starts what the stories need: a real system with a real page, and a real browser. */
import { mkdirSync, existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';
import { expect, onTestFinished } from 'vitest';

import { startSystem, type Program, type System } from './system';

export const CHROMIUM = process.env.PARLEY_CHROMIUM ?? '/usr/bin/chromium';
const ARGUMENTS = [
  '--headless',
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
/** Git ignores it. */
const FAILURES = 'screenshots/failures';
/** What the page waits for at most; the machine may be busy with other things. */
export const PATIENCE_MS = 40_000;

export const hasBrowser = existsSync(CHROMIUM);

if (!hasBrowser && process.env.PARLEY_REQUIRE_BROWSER === '1') {
  throw new Error(`there is no Chromium at ${CHROMIUM}, and the browser tests are required here`);
}

export interface Size {
  width: number;
  height: number;
}

export interface Stage {
  browser: Browser;
  system: System;
  /** A new page of a size, opened at a path such as `#/plan`, perhaps with what it kept; closed when the test ends. */
  open: (size: Size, path?: string, dark?: boolean, prefs?: string) => Promise<Page>;
  /** What the server says under `/api/`. */
  get: <T>(path: string) => Promise<T>;
  close: () => Promise<void>;
}

/**
 * Start the system and the browser.
 * @throws Error The system did not serve its page in time; its output is in the message.
 */
export async function startStage(options: readonly string[] = [], program: Program = 'nursing-home'): Promise<Stage> {
  const [system, browser] = await Promise.all([
    startSystem(program, options),
    chromium.launch({ executablePath: CHROMIUM, args: ARGUMENTS }),
  ]);
  return {
    browser,
    system,
    open: async (viewport, path = '', dark = false, prefs = '') => {
      const context = await browser.newContext({
        viewport,
        colorScheme: dark ? 'dark' : 'light',
        locale: 'en-GB',
        reducedMotion: 'reduce',
        hasTouch: viewport.width < 1000,
        ignoreHTTPSErrors: true, // the machine made its own certificate
        serviceWorkers: 'block',
      });
      context.setDefaultTimeout(PATIENCE_MS);
      if (prefs) await context.addInitScript((kept) => localStorage.setItem('parley.prefs', kept), prefs);
      const page = await context.newPage();
      watch(page, context);
      await page.goto(system.address + path);
      return page;
    },
    get: async <T>(path: string) => {
      const response = await fetch(`${system.address}api/${path}`);
      return (await response.json()) as T;
    },
    close: async () => {
      await browser.close();
      await system.close();
    },
  };
}

/** Keeps a picture of a page whose story failed, and fails the story in which the page broke. */
function watch(page: Page, context: BrowserContext): void {
  const broken: string[] = [];
  page.on('pageerror', (error) => broken.push(error.message));
  page.on('console', (message) => {
    if (/Content Security Policy/.test(message.text())) broken.push(message.text());
  });
  onTestFinished(async ({ task }) => {
    if (task.result?.state === 'fail') await keepPicture(page, task.name);
    await context.close();
    expect(broken).toEqual([]);
  });
}

async function keepPicture(page: Page, story: string): Promise<void> {
  mkdirSync(FAILURES, { recursive: true });
  const name = `${story.replaceAll(/[^a-z0-9]+/gi, '-').slice(0, 80)}-${page.viewportSize()?.width}`;
  await page.screenshot({ path: `${FAILURES}/${name}.png`, timeout: 5000 }).catch(() => undefined);
}

export const sizes = {
  phone: { width: 390, height: 844 },
  tablet: { width: 820, height: 1180 },
  desktop: { width: 1440, height: 900 },
} as const;

/** Write something in the chat and send it. */
export async function say(page: Page, text: string): Promise<void> {
  const box = page.getByRole('textbox', { name: /^Write to/ });
  await box.fill(text);
  await box.press('Enter');
}

export const steps = (page: Page) => page.getByRole('region', { name: 'Steps' });

interface Robot {
  name: string;
  state: string;
  connection: string;
  pose: { x: number; y: number } | null;
}

export async function robotNamed(stage: Stage, name = 'David'): Promise<Robot | undefined> {
  return (await stage.get<Robot[]>('robots')).find((robot) => robot.name === name);
}

/** Metres between two places of a robot; infinite where one of them is not known. */
export function distance(one: Robot | undefined, other: Robot | undefined): number {
  if (!one?.pose || !other?.pose) return Number.POSITIVE_INFINITY;
  return Math.hypot(one.pose.x - other.pose.x, one.pose.y - other.pose.y);
}

/** Wait until a robot has driven some metres from where it is now, or was. */
export async function untilItMoved(stage: Stage, from: Robot | undefined, metres = 0.3): Promise<void> {
  const start = from ?? (await robotNamed(stage));
  const moved = async () => distance(await robotNamed(stage, start?.name), start);
  await expect.poll(moved, { timeout: PATIENCE_MS, interval: 250 }).toBeGreaterThan(metres);
}

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface Axe {
  run: (where: Document, options: object) => Promise<{ violations: { id: string; nodes: { html: string }[] }[] }>;
}

/** Rules about colours, which take most of the time, those about all else, or both. */
export type Rules = 'all' | 'colours' | 'all else';
const COLOURS = ['color-contrast', 'link-in-text-block'];

/** What keeps people from using the page as it is now, by the rules of WCAG 2.2 AA and good practice. */
export async function barriers(page: Page, rules: Rules = 'all'): Promise<string[]> {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(axe);
  return page.evaluate(
    async ({ which, colours }) => {
      const runner = (window as unknown as { axe: Axe }).axe;
      const tags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
      // Behind an open box the page is out of reach, so what a whole page must have is looked for only without one.
      const enabled = document.querySelector('[role="dialog"], [role="alertdialog"]') === null;
      const off = which === 'all else' ? colours.map((rule) => [rule, { enabled: false }] as const) : [];
      const whole = ['landmark-one-main', 'page-has-heading-one'].map((rule) => [rule, { enabled }] as const);
      const options = which === 'colours' ? { runOnly: colours } : { runOnly: tags, rules: Object.fromEntries([...whole, ...off]) };
      const result = await runner.run(document, { ...options, resultTypes: ['violations'] });
      return result.violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ')}`);
    },
    { which: rules, colours: COLOURS },
  );
}

/** The same of a page in every size and look; what is open in it stays open. */
export async function barriersInEveryLook(page: Page): Promise<string[]> {
  const found: string[] = [];
  const before = page.viewportSize() ?? sizes.desktop;
  for (const [size, box] of Object.entries(sizes)) {
    await page.setViewportSize(box);
    for (const look of ['light', 'dark', 'contrast', 'forced']) {
      await page.emulateMedia(look === 'forced' ? { forcedColors: 'active', colorScheme: 'dark' } : { forcedColors: 'none', colorScheme: 'light' });
      await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), look === 'forced' ? 'dark' : look);
      found.push(...(await barriers(page, look === 'light' ? 'all' : 'colours')).map((barrier) => `${size} ${look}: ${barrier}`));
    }
  }
  await page.setViewportSize(before);
  await page.emulateMedia({ forcedColors: 'none', colorScheme: 'light' });
  return found;
}
