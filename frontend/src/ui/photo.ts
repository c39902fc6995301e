import type { Photo } from '@/state/drafts';

const LONGEST_SIDE_PX = 1280;
const QUALITY = 0.85;

/**
 * Read a picture file, made small enough to send.
 * @throws Error It is no picture that this browser can read.
 */
export async function readPhoto(file: File): Promise<Photo> {
  const picture = await createImageBitmap(file);
  const scale = Math.min(1, LONGEST_SIDE_PX / Math.max(picture.width, picture.height));
  const canvas = document.createElement('canvas');
  canvas.width = Math.max(1, Math.round(picture.width * scale));
  canvas.height = Math.max(1, Math.round(picture.height * scale));
  const context = canvas.getContext('2d');
  if (!context) throw new Error('this browser cannot draw');
  context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  picture.close();
  const address = canvas.toDataURL('image/jpeg', QUALITY);
  return { name: file.name, data: address.slice(address.indexOf(',') + 1) };
}
