import { afterEach, expect, it, vi } from 'vitest';

import { useStopping } from './stopping';

const leaving = () => window.dispatchEvent(new Event('beforeunload', { cancelable: true }));

afterEach(() => useStopping.getState().callOff());

it('a stop outlives the page that sent it, and nobody closes the page unasked before it is taken', () => {
  const sent: RequestInit[] = [];
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    sent.push(options);
    return new Promise(() => undefined);
  });
  void useStopping.getState().stop(['Ada']);
  expect(sent).toMatchObject([{ method: 'POST', keepalive: true }]);
  expect(leaving()).toBe(false);
  useStopping.getState().callOff();
  expect(leaving()).toBe(true);
});
