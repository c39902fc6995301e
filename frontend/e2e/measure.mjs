/** What the page costs: size, time until one can write, and how old a camera's picture is when it is painted. One JSON line. */
import { spawn } from 'node:child_process';
import { mkdtemp, readdir, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

import { chromium } from 'playwright-core';

const PARLEY = process.env.PARLEY_COMMAND ?? '../.venv/bin/parley';
const CHROMIUM = process.env.PARLEY_CHROMIUM ?? '/usr/bin/chromium';
const ARGUMENTS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking'];
const FILES = '../src/parley/web/static/assets';
const WATCH_MS = 15_000;
const OPENINGS = 5;

const share = (values, part) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(values.length * part))];

/** Runs in the page before anything else: notes when pictures came and when they were painted. */
function watchPictures() {
  const found = { socket: [], painted: [] };
  window.measured = found;
  let newest = 0;
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...where) {
      super(...where);
      this.addEventListener('message', ({ data }) => {
        const taken = typeof data === 'string' && data.includes('"frame"') ? /"unix_ms":(\d+)/.exec(data) : null;
        if (!taken) return;
        newest = Number(taken[1]);
        found.socket.push(Date.now() - newest);
      });
    }
  };
  const onLoad = ({ target }) => {
    if (target?.tagName !== 'IMG' || !target.src.startsWith('blob:')) return;
    const taken = newest;
    // The callback comes right before the picture is painted, the one after it right behind that.
    requestAnimationFrame(() => setTimeout(() => found.painted.push(Date.now() - taken)));
  };
  document.addEventListener('load', onLoad, { capture: true });
}

function started(system) {
  return new Promise((settle, reject) => {
    let output = '';
    system.stdout.on('data', (data) => {
      output += data;
      const address = /https?:\/\/127\.0\.0\.1:\d+\//.exec(output)?.[0];
      if (address) settle(address);
    });
    system.once('exit', () => reject(new Error(`the system ended: ${output}`)));
  });
}

const data = await mkdtemp(join(tmpdir(), 'parley-measure-'));
const system = spawn(PARLEY, ['demo', 'nursing-home', '--no-open', '--port', '0', '--data', data], { stdio: ['ignore', 'pipe', 'inherit'] });
const browser = await chromium.launch({ executablePath: CHROMIUM, args: ARGUMENTS });
try {
  const address = await started(system);
  const interactive = [];
  for (let opening = 0; opening < OPENINGS; opening += 1) {
    const page = await (await browser.newContext({ serviceWorkers: 'block' })).newPage();
    await page.goto(address, { waitUntil: 'commit' });
    await page.waitForFunction(() => document.querySelector('textarea:enabled'), undefined, { polling: 'raf' });
    interactive.push(await page.evaluate(() => performance.now()));
    await page.context().close();
  }
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 }, serviceWorkers: 'block' })).newPage();
  await page.addInitScript(watchPictures);
  await page.goto(address);
  await page.waitForFunction(() => window.measured.painted.length > 5, undefined, { timeout: 60_000 });
  await page.evaluate(() => Object.values(window.measured).forEach((times) => times.splice(0)));
  await page.waitForTimeout(WATCH_MS);
  const { socket, painted } = await page.evaluate(() => window.measured);
  const files = await Promise.all((await readdir(FILES)).map((name) => readFile(join(FILES, name))));
  const kb = (sizes) => Math.round(sizes.reduce((sum, size) => sum + size, 0) / 1000);
  const figures = {
    files_kb: kb(files.map((file) => file.length)),
    files_gzip_kb: kb(files.map((file) => gzipSync(file).length)),
    interactive_p50_ms: Math.round(share(interactive, 0.5)),
    interactive_max_ms: Math.round(Math.max(...interactive)),
    pictures: painted.length,
    socket_p50_ms: share(socket, 0.5),
    socket_p95_ms: share(socket, 0.95),
    painted_p50_ms: share(painted, 0.5),
    painted_p95_ms: share(painted, 0.95),
  };
  console.log(JSON.stringify(figures));
} finally {
  await browser.close();
  system.kill('SIGINT');
  await new Promise((settle) => system.once('exit', settle));
  await rm(data, { recursive: true, force: true });
}
