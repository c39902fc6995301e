import { ApiError } from './api';

/**
 * The bytes of a picture on this server, as base64.
 * @throws ApiError It is not there, or the server was not reached.
 */
export async function fetchPicture(address: string): Promise<string> {
  const response = await fetch(address, { credentials: 'same-origin' }).catch(() => {
    throw new ApiError(0, '');
  });
  if (!response.ok) throw new ApiError(response.status, '');
  const bytes = new Uint8Array(await response.arrayBuffer().catch(() => {
    throw new ApiError(0, '');
  }));
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}
