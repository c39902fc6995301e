/**
 * A Chromium that is steered as little as possible, for measuring. What tests are driven with (Playwright) has the browser
 * report everything that comes over the network, each picture a second time as text: that took a quarter of a processor
 * and made pictures late which without it are not. Here only what is asked is answered.
 */
import { spawn } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const CHROMIUM = process.env.PARLEY_CHROMIUM ?? '/usr/bin/chromium';
/** Nothing of the browser's own business, such as updates and a first window, is to run beside what is measured. */
const ARGUMENTS = [
  ...['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking'],
  ...['--no-startup-window', '--no-default-browser-check', '--disable-component-update', '--disable-default-apps'],
  ...['--disable-component-extensions-with-background-pages', '--disable-extensions', '--disable-sync', '--disable-breakpad'],
  ...['--disable-search-engine-choice-screen', '--password-store=basic', '--hide-scrollbars', '--remote-debugging-pipe'],
];
const END = '\0';
const TO_BROWSER = 3;
const FROM_BROWSER = 4;
const ASK_EVERY_MS = 10;

/** Start a browser. @returns How to open a page in it, and how to end it. */
export async function launch() {
  const folder = await mkdtemp(join(tmpdir(), 'parley-measure-'));
  const stdio = ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'];
  const child = spawn(CHROMIUM, [...ARGUMENTS, `--user-data-dir=${folder}`], { stdio });
  const waiting = new Map();
  const ended = new Promise((resolve) => {
    child.once('exit', resolve).once('error', resolve);
  });
  let over = false;
  void ended.then(() => {
    over = true;
    for (const { reject } of waiting.values()) reject(new Error('the browser ended'));
    waiting.clear();
  });
  let number = 0;
  let begun = '';
  child.stdio[FROM_BROWSER].setEncoding('utf8').on('data', (text) => {
    const parts = (begun + text).split(END);
    begun = parts.pop();
    for (const part of parts) {
      const { id, result, error } = JSON.parse(part);
      const who = waiting.get(id);
      waiting.delete(id);
      if (error) who?.reject(new Error(error.message));
      else who?.resolve(result);
    }
  });
  const ask = (method, params = {}, sessionId = undefined) =>
    new Promise((resolve, reject) => {
      if (over) throw new Error('the browser ended');
      number += 1;
      waiting.set(number, { resolve, reject });
      child.stdio[TO_BROWSER].write(JSON.stringify({ id: number, method, params, sessionId }) + END);
    });
  const close = async () => {
    await ask('Browser.close').catch(() => undefined);
    await ended;
    await rm(folder, { recursive: true, force: true, maxRetries: 5 });
  };
  return { ask, open: (screen, ...scripts) => openPage(ask, screen, scripts), close };
}

/** A page of its own, that shares nothing with others. `scripts` are functions that run in it before anything else. */
async function openPage(ask, { width, height }, scripts) {
  const { browserContextId } = await ask('Target.createBrowserContext');
  const { targetId } = await ask('Target.createTarget', { url: 'about:blank', browserContextId, width, height });
  const { sessionId } = await ask('Target.attachToTarget', { targetId, flatten: true });
  const inPage = (method, params) => ask(method, params, sessionId);
  await inPage('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
  await inPage('Page.enable');
  for (const script of scripts) await inPage('Page.addScriptToEvaluateOnNewDocument', { source: `(${String(script)})()` });
  const evaluate = async (what, ...values) => {
    const expression = `(${String(what)})(...${JSON.stringify(values)})`;
    const { result, exceptionDetails } = await inPage('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  };
  return {
    ask: inPage,
    evaluate,
    goTo: (address) => inPage('Page.navigate', { url: address }),
    /** Ask until the answer is not empty. */
    until: async (what, patienceMs, ...values) => {
      const deadline = Date.now() + patienceMs;
      for (;;) {
        const answer = await evaluate(what, ...values);
        if (answer) return answer;
        if (Date.now() > deadline) throw new Error('the page did not come so far in time');
        await new Promise((resolve) => setTimeout(resolve, ASK_EVERY_MS));
      }
    },
    close: () => ask('Target.disposeBrowserContext', { browserContextId }),
  };
}
