import { expect, it, vi } from 'vitest';

import { ApiError, getModels } from './api';

it('takes an answer that is cut off for a server that was not reached', async () => {
  const cut = new ReadableStream({ start: (stream) => stream.error(new TypeError('Failed to fetch')) });
  vi.stubGlobal('fetch', () => Promise.resolve(new Response(cut)));
  await expect(getModels()).rejects.toEqual(new ApiError(0, ''));
});

it('says what the server says, and nothing of what is not for people', async () => {
  for (const [body, message] of [['{"detail": "Not now."}', 'Not now.'], ['<html>Bad gateway</html>', ''], ['{"detail": "Not', '']] as const) {
    vi.stubGlobal('fetch', () => Promise.resolve(new Response(body, { status: 502 })));
    await expect(getModels()).rejects.toEqual(new ApiError(502, message));
  }
});
