/** In dots. */
export interface Size {
  width: number;
  height: number;
}

const JPEG = 'image/jpeg';
const JPEG_BEGINS = 0xffd8;

/** By its bytes: what a robot says of them may be wrong. */
const isJpeg = (bytes: ArrayBuffer): boolean => bytes.byteLength > 2 && new DataView(bytes).getUint16(0) === JPEG_BEGINS;

/**
 * A picture from its bytes, read beside the page's own work.
 *
 * @param size How large at least: a picture that is read smaller than it is takes half the time to read, move and draw.
 *   Null: as it is. Browsers that cannot do so, and kinds of pictures with which it cannot be done, give it as it is.
 */
export async function decode(bytes: ArrayBuffer, size: Size | null): Promise<ImageBitmap> {
  if (!size || !isJpeg(bytes) || !('ImageDecoder' in window)) return createImageBitmap(new Blob([bytes]));
  const { width: desiredWidth, height: desiredHeight } = size;
  const decoder = new ImageDecoder({ data: bytes, type: JPEG, desiredWidth, desiredHeight });
  try {
    const { image } = await decoder.decode();
    try {
      return await createImageBitmap(image);
    } finally {
      image.close();
    }
  } finally {
    decoder.close();
  }
}

const STEPS = 8;

/**
 * What to ask for so that a picture of the size `whole` is not smaller than its place: pictures are read in eighths of their
 * size. Null: all of it.
 */
export function sizeFor(whole: Size | null, place: Size): Size | null {
  if (!whole || place.width <= 0 || place.height <= 0) return null;
  const eighths = Math.ceil(STEPS * Math.max(place.width / whole.width, place.height / whole.height));
  if (eighths >= STEPS) return null;
  return { width: Math.ceil((whole.width * eighths) / STEPS), height: Math.ceil((whole.height * eighths) / STEPS) };
}
