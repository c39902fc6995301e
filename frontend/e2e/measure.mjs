/**
 * What the page costs in a real browser: the size of its files, the time until one can write, and how old pictures are
 * when they come and when they are painted. Called by `parley bench web` as: npm run measure -- ADDRESS SECONDS FEEDS.
 * The last eight bytes of each picture are the time of its taking, in nanoseconds. Prints one JSON line.
 */
import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { gzipSync } from 'node:zlib';

import { launch } from './browser.mjs';

const FILES = '../src/parley/web/static/assets';
const OPENINGS = 5;
const WINDOW = { width: 1280, height: 720 };
/** Large enough for all pictures to be seen at once. */
const SCREEN = { width: 1920, height: 1080 };
const WARM_UP_MS = 1000;
const PATIENCE_MS = 60_000;

const [address, seconds, feeds] = process.argv.slice(2);

/** Runs in the page before anything else: its files come from the server each time. */
function withoutWorker() {
  if (navigator.serviceWorker) navigator.serviceWorker.register = () => new Promise(() => undefined);
}

/**
 * Runs in the page before anything else: notes how old pictures are when they come, and when they are painted. It asks
 * nothing of the browser that the page does not, or it would measure itself.
 */
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
  // When a picture was taken goes from its bytes to what is made of them, up to the bitmap that is drawn.
  const taken = new WeakMap();
  window.Blob = class extends window.Blob {
    constructor(parts, options) {
      super(parts, options);
      const [first] = parts ?? [];
      if (first instanceof ArrayBuffer && first.byteLength > 8) taken.set(this, takenMs(first));
    }
  };
  if (window.ImageDecoder) {
    window.ImageDecoder = class extends window.ImageDecoder {
      constructor(options) {
        taken.set(super(options), takenMs(options.data));
      }
      async decode(options) {
        const decoded = await super.decode(options);
        taken.set(decoded.image, taken.get(this));
        return decoded;
      }
    };
  }
  const read = window.createImageBitmap.bind(window);
  window.createImageBitmap = async (source, ...options) => {
    const bitmap = await read(source, ...options);
    taken.set(bitmap, taken.get(source));
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
  const page = await browser.open(WINDOW, withoutWorker);
  await page.goTo(address);
  const took = await page.until(() => document.querySelector('textarea:enabled') && performance.now(), PATIENCE_MS);
  await page.close();
  return took;
}

async function watch(browser) {
  const page = await browser.open(SCREEN, withoutWorker, watchPictures);
  await page.goTo(`${address}#/display`);
  await page.until((wanted) => window.measured?.drawn.size >= wanted, PATIENCE_MS, Number(feeds));
  await sleep(WARM_UP_MS);
  const inSight = await page.evaluate(() => {
    const { drawn } = window.measured;
    Object.assign(window.measured, { socket: [], painted: [] });
    return [...drawn].filter((canvas) => canvas.getBoundingClientRect().bottom <= window.innerHeight).length;
  });
  await sleep(Number(seconds) * 1000);
  const { socket, painted } = await page.evaluate(() => ({ ...window.measured, drawn: [] }));
  return { socket, painted, inSight };
}

const browser = await launch();
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
