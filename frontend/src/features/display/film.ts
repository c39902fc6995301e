import type { FrameMeta } from '@/live/connection';

import { sizeFor, type Size } from './decode';

type Decode = (bytes: ArrayBuffer, size: Size | null) => Promise<ImageBitmap>;

/** The part of a canvas that is needed. */
interface Screen {
  width: number;
  height: number;
  /** In the page, in its own measure. */
  readonly clientWidth: number;
  readonly clientHeight: number;
  getContext: (kind: 'bitmaprenderer') => Pick<ImageBitmapRenderingContext, 'transferFromImageBitmap'> | null;
}

/**
 * Draws the pictures of one feed as they come, past the components around them: those change once a second, films ten
 * times. A bitmap becomes the canvas's own, nothing is copied; one that a newer overtook is let go of.
 */
export class Film {
  #came = 0;
  #newest = 0;
  #ended = false;
  #screen: Screen | null = null;
  #waiting: { bitmap: ImageBitmap; onDrawn: () => void } | null = null;
  /** How large pictures are before they are made smaller. */
  #whole: Size | null = null;
  readonly #decode: Decode;
  readonly #onPicture: (meta: FrameMeta) => void;

  /** @param onPicture Told of each picture that is to be drawn, before it is. */
  constructor(decode: Decode, onPicture: (meta: FrameMeta) => void) {
    this.#decode = decode;
    this.#onPicture = onPicture;
  }

  /** Show a picture. @returns When it is drawn, or was overtaken. */
  async take(bytes: ArrayBuffer, meta: FrameMeta): Promise<void> {
    this.#came += 1;
    const number = this.#came;
    const size = this.#sizeNow();
    const bitmap = await this.#decode(bytes, size);
    if (!size) this.#whole = { width: bitmap.width, height: bitmap.height };
    else if (bitmap.width !== size.width) this.#whole = null; // the camera sends others now
    if (this.#ended || number < this.#newest) {
      bitmap.close();
      return;
    }
    this.#newest = number;
    this.#letGo();
    await new Promise<void>((onDrawn) => {
      this.#waiting = { bitmap, onDrawn };
      this.#onPicture(meta);
      this.#draw();
    });
  }

  /** From now on pictures are drawn here; what came before there was a place is drawn at once. */
  drawOn(screen: Screen | null): void {
    this.#screen = screen;
    this.#draw();
  }

  end(): void {
    this.#ended = true;
    this.#letGo();
  }

  #sizeNow(): Size | null {
    if (!this.#screen) return null;
    const { clientWidth, clientHeight } = this.#screen;
    const dense = window.devicePixelRatio;
    return sizeFor(this.#whole, { width: clientWidth * dense, height: clientHeight * dense });
  }

  #draw(): void {
    const screen = this.#screen;
    if (!screen || !this.#waiting) return;
    const { bitmap, onDrawn } = this.#waiting;
    this.#waiting = null;
    if (screen.width !== bitmap.width) screen.width = bitmap.width;
    if (screen.height !== bitmap.height) screen.height = bitmap.height;
    screen.getContext('bitmaprenderer')?.transferFromImageBitmap(bitmap);
    onDrawn();
  }

  #letGo(): void {
    this.#waiting?.bitmap.close();
    this.#waiting?.onDrawn();
    this.#waiting = null;
  }
}
