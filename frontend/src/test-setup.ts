import { cleanup } from '@testing-library/react';
import { afterEach, beforeAll, beforeEach } from 'vitest';

import { startWords } from './i18n';
import { useLive } from './live/store';
import { useSelectionStore } from './state/selection';
import { useToasts } from './state/toasts';

class NoResize {
  observe() {}
  unobserve() {}
  disconnect() {}
}

beforeAll(async () => {
  // What jsdom lacks of a browser.
  window.CSS ??= {} as typeof CSS;
  window.CSS.escape ??= (text: string) => text.replaceAll(/[^\w-]/g, (sign) => `\\${sign}`);
  Element.prototype.scrollIntoView ??= () => undefined;
  // There is no screen: it counts as a large one.
  window.matchMedia ??= (query) => Object.assign(new EventTarget(), { matches: true, media: query }) as MediaQueryList;
  window.matchMedia ??= () => Object.assign(new EventTarget(), { matches: false }) as unknown as MediaQueryList;
  window.ResizeObserver ??= NoResize as unknown as typeof ResizeObserver;
  await startWords('en');
});

beforeEach(() => {
  localStorage.clear();
  useLive.setState(useLive.getInitialState(), true);
  useSelectionStore.setState(useSelectionStore.getInitialState(), true);
  useToasts.setState(useToasts.getInitialState(), true);
});

afterEach(cleanup);
