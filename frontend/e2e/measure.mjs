/**
 * What the page costs in a real browser: the size of its files, the time until one can write, and how old pictures are
 * when they come and when they are painted. Called by `parley bench web` as: npm run measure -- ADDRESS SECONDS FEEDS.
 * The last eight bytes of each picture are the time of its taking, in nanoseconds. Prints one JSON line.
 */
import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

import { chromium } from 'playwright-core';

const CHROMIUM = process.env.PARLEY_CHROMIUM ?? '/usr/bin/chromium';
const ARGUMENTS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking'];
const FILES = '../src/parley/web/static/assets';
const OPENINGS = 5;
/** Large enough for all pictures to be seen at once. */
const SCREEN = { width: 1920, height: 1080 };
const WARM_UP_MS = 1000;
const PATIENCE_MS = 60_000;

const [address, seconds, feeds] = process.argv.slice(2);

/** Runs in the page before anything else: notes how old pictures are when they come, and when they are painted. */
function watchPictures() {
  const found = { socket: [], painted: [], drawn: new Set() };
  window.measured = found;
  const takenMs = (bytes) => Number(new DataView(bytes).getBigUint64(bytes.byteLength - 8)) / 1e6;
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...where) {
      super(...where);
      this.addEventListener('message', ({ data }) => {
        if (data instanceof ArrayBuffer) found.socket.push(Date.now() - takenMs(data));
      });
    }
  };
  const taken = new WeakMap();
  const read = window.createImageBitmap.bind(window);
  window.createImageBitmap = async (blob) => {
    const [bitmap, made] = await Promise.all([read(blob), blob.slice(-8).arrayBuffer().then(takenMs)]);
    taken.set(bitmap, made);
    return bitmap;
  };
  const canvas = window.ImageBitmapRenderingContext.prototype;
  const draw = canvas.transferFromImageBitmap;
  canvas.transferFromImageBitmap = function (bitmap) {
    const made = taken.get(bitmap);
    draw.call(this, bitmap);
    found.drawn.add(this.canvas);
    // The callback comes right before the canvas is painted, the one after it right behind that.
    requestAnimationFrame(() => setTimeout(() => found.painted.push(Date.now() - made)));
  };
}

/** Milliseconds from the beginning of an opening until one can write. */
async function open(browser) {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  await page.goto(address, { waitUntil: 'commit' });
  const canWrite = () => document.querySelector('textarea:enabled') && performance.now();
  const took = await (await page.waitForFunction(canWrite, undefined, { polling: 'raf', timeout: PATIENCE_MS })).jsonValue();
  await context.close();
  return took;
}

async function watch(browser) {
  const page = await (await browser.newContext({ viewport: SCREEN, serviceWorkers: 'block' })).newPage();
  await page.addInitScript(watchPictures);
  await page.goto(`${address}#/display`);
  await page.waitForFunction((wanted) => window.measured.drawn.size >= wanted, Number(feeds), { timeout: PATIENCE_MS });
  await page.waitForTimeout(WARM_UP_MS);
  const inSight = await page.evaluate(() => {
    const { drawn } = window.measured;
    Object.assign(window.measured, { socket: [], painted: [] });
    return [...drawn].filter((canvas) => canvas.getBoundingClientRect().bottom <= window.innerHeight).length;
  });
  await page.waitForTimeout(Number(seconds) * 1000);
  const { socket, painted } = await page.evaluate(() => window.measured);
  return { socket, painted, inSight };
}

const browser = await chromium.launch({ executablePath: CHROMIUM, args: ARGUMENTS });
try {
  const interactive = [];
  while (interactive.length < OPENINGS) interactive.push(await open(browser));
  const { socket, painted, inSight } = Number(feeds) > 0 ? await watch(browser) : { socket: [], painted: [], inSight: 0 };
  const files = await Promise.all((await readdir(FILES)).map((name) => readFile(join(FILES, name))));
  const bytes = (contents) => contents.reduce((sum, one) => sum + one.length, 0);
  console.log(
    JSON.stringify({
      files_bytes: bytes(files),
      files_gzip_bytes: bytes(files.map((file) => gzipSync(file))),
      interactive_ms: interactive,
      socket_ms: socket,
      painted_ms: painted,
      in_sight: inSight,
    }),
  );
} finally {
  await browser.close();
}
