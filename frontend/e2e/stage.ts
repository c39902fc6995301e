/** Starts what the stories need: a real system with a real page, and a real browser. */
import { spawn, type ChildProcess } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { chromium, type Browser, type Page } from 'playwright-core';

export const CHROMIUM = process.env.PARLEY_CHROMIUM ?? '/usr/bin/chromium';
const PARLEY = process.env.PARLEY_COMMAND ?? '../.venv/bin/parley';
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
const START_MS = 40_000;
const END_MS = 8_000;

export const hasBrowser = existsSync(CHROMIUM);

if (!hasBrowser && process.env.PARLEY_REQUIRE_BROWSER === '1') {
  throw new Error(`there is no Chromium at ${CHROMIUM}, and the browser tests are required here`);
}

export interface Stage {
  browser: Browser;
  address: string;
  /** A new page of a size, opened at a path such as `#/plan`. */
  open: (size: { width: number; height: number }, path?: string, dark?: boolean) => Promise<Page>;
  close: () => Promise<void>;
}

/**
 * Start the system and the browser.
 * @throws Error The system did not serve its page in time; its output is in the message.
 */
export async function startStage(...options: string[]): Promise<Stage> {
  const data = await mkdtemp(join(tmpdir(), 'parley-e2e-'));
  const system = spawn(PARLEY, ['demo', 'nursing-home', '--no-open', '--port', '0', '--data', data, ...options], {
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  const [address, browser] = await Promise.all([
    servedAddress(system),
    chromium.launch({ executablePath: CHROMIUM, args: ARGUMENTS }),
  ]);
  return {
    browser,
    address,
    open: async (viewport, path = '', dark = false) => {
      const context = await browser.newContext({
        viewport,
        colorScheme: dark ? 'dark' : 'light',
        locale: 'en-GB',
        reducedMotion: 'reduce',
        hasTouch: viewport.width < 1000,
      });
      const page = await context.newPage();
      await page.goto(address + path);
      return page;
    },
    close: async () => {
      await browser.close();
      await ended(system);
      await rm(data, { recursive: true, force: true });
    },
  };
}

function servedAddress(system: ChildProcess): Promise<string> {
  return new Promise((resolve, reject) => {
    let output = '';
    const timer = setTimeout(() => reject(new Error(`no page after ${START_MS} ms:\n${output}`)), START_MS);
    const listen = (data: Buffer) => {
      output += data.toString();
      const found = /https?:\/\/127\.0\.0\.1:\d+\//.exec(output)?.[0];
      if (found) {
        clearTimeout(timer);
        resolve(found);
      }
    };
    system.stdout?.on('data', listen);
    system.stderr?.on('data', listen);
    system.once('error', reject);
    system.once('exit', (code) => reject(new Error(`the system ended with ${code}:\n${output}`)));
  });
}

function ended(system: ChildProcess): Promise<void> {
  return new Promise((resolve) => {
    if (system.exitCode !== null) {
      resolve();
      return;
    }
    const timer = setTimeout(() => system.kill('SIGKILL'), END_MS);
    system.once('exit', () => {
      clearTimeout(timer);
      resolve();
    });
    system.kill('SIGINT');
  });
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
