import { describe, expect, it, vi } from 'vitest';

import type { FrameMeta } from '@/live/connection';

import { sizeFor, type Size } from './decode';
import { Film } from './film';

const meta: FrameMeta = { robot: 'Ada', name: 'camera', unix_ms: 1 };
const bytesOf = (name: number) => new Uint8Array([name]).buffer;

/** A bitmap is known by the only byte of its picture. */
interface Named extends ImageBitmap {
  of: number;
}

/** Reads pictures when it is told to, in whatever order. */
function rig(whole: Size = { width: 640, height: 480 }) {
  const reads: { size: Size | null; done: (fails?: Error, width?: number) => Promise<void> }[] = [];
  const closed: number[] = [];
  const drawn: number[] = [];
  const decode = (bytes: ArrayBuffer, size: Size | null) =>
    new Promise<ImageBitmap>((resolve, reject) => {
      const of = new Uint8Array(bytes)[0] ?? 0;
      const bitmap = { of, ...(size ?? whole), close: () => closed.push(of) } as Named;
      const done = async (fails?: Error, width?: number) => {
        if (fails) reject(fails);
        else resolve({ ...bitmap, width: width ?? bitmap.width });
        await new Promise((next) => setTimeout(next));
      };
      reads.push({ size, done });
    });
  const screen = {
    width: 0,
    height: 0,
    clientWidth: 320,
    clientHeight: 240,
    getContext: () => ({ transferFromImageBitmap: (bitmap: ImageBitmap | null) => void drawn.push((bitmap as Named).of) }),
  };
  const told = vi.fn();
  return { film: new Film(decode, told), reads, closed, drawn, screen, told };
}

describe('a film', () => {
  it('draws a picture that came before there was a place for it', async () => {
    const { film, reads, drawn, screen, told } = rig();
    const shown = film.take(bytesOf(1), meta);
    await reads[0]?.done();
    expect([told.mock.calls, drawn]).toEqual([[[meta]], []]);
    film.drawOn(screen);
    await shown;
    expect([drawn, screen.width, screen.height]).toEqual([[1], 640, 480]);
  });

  it('is not drawn when a newer picture was read sooner, and neither waits for the other', async () => {
    const { film, reads, closed, drawn, screen } = rig();
    film.drawOn(screen);
    const both = [film.take(bytesOf(1), meta), film.take(bytesOf(2), meta)];
    await reads[1]?.done();
    await reads[0]?.done();
    await Promise.all(both);
    expect([drawn, closed]).toEqual([[2], [1]]);
  });

  it('lets go of a picture for which no place came', async () => {
    const { film, reads, closed, drawn, screen } = rig();
    const first = film.take(bytesOf(1), meta);
    await reads[0]?.done();
    const second = film.take(bytesOf(2), meta);
    await reads[1]?.done();
    await first;
    film.end();
    await second;
    film.drawOn(screen);
    expect([drawn, closed]).toEqual([[], [1, 2]]);
  });

  it('draws nothing any more after its end', async () => {
    const { film, reads, closed, drawn, screen, told } = rig();
    film.drawOn(screen);
    const late = film.take(bytesOf(1), meta);
    film.end();
    await reads[0]?.done();
    await late;
    expect([drawn, closed, told.mock.calls.length]).toEqual([[], [1], 0]);
  });

  it('goes on after a picture that cannot be read', async () => {
    const { film, reads, drawn, screen } = rig();
    film.drawOn(screen);
    const broken = film.take(bytesOf(1), meta);
    const refused = expect(broken).rejects.toThrow('unreadable');
    await reads[0]?.done(new Error('unreadable'));
    await refused;
    const next = film.take(bytesOf(2), meta);
    await reads[1]?.done();
    await next;
    expect(drawn).toEqual([2]);
  });

  it('asks for pictures as large as their place once it knows how large they are', async () => {
    const { film, reads, screen } = rig({ width: 1920, height: 1080 });
    film.drawOn(screen);
    for (const name of [1, 2]) {
      const shown = film.take(bytesOf(name), meta);
      await reads[name - 1]?.done();
      await shown;
    }
    expect(reads.map(({ size }) => size)).toEqual([null, { width: 480, height: 270 }]);
  });

  it('looks again how large pictures are when one is not as large as was asked for', async () => {
    const { film, reads, screen } = rig({ width: 1920, height: 1080 });
    film.drawOn(screen);
    for (const comesWith of [undefined, 320, undefined]) {
      const shown = film.take(bytesOf(1), meta);
      await reads.at(-1)?.done(undefined, comesWith);
      await shown;
    }
    expect(reads.map(({ size }) => size?.width ?? null)).toEqual([null, 480, null]);
  });
});

describe('the size that is asked for', () => {
  const whole = { width: 640, height: 480 };

  it('is never smaller than the place', () => {
    for (let width = 1; width <= 800; width += 7) {
      const size = sizeFor(whole, { width, height: (width * 3) / 4 }) ?? whole;
      expect(size.width).toBeGreaterThanOrEqual(Math.min(width, whole.width));
    }
  });

  it('fills a place of another shape', () => {
    expect(sizeFor(whole, { width: 100, height: 300 })).toEqual({ width: 400, height: 300 });
  });

  it('is the whole one where the place is larger, or nothing is known', () => {
    expect([sizeFor(whole, { width: 700, height: 100 }), sizeFor(null, whole), sizeFor(whole, { width: 0, height: 0 })]).toEqual([null, null, null]);
  });
});
