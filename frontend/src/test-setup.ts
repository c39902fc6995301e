import { cleanup } from '@testing-library/react';
import { afterEach, beforeAll, beforeEach } from 'vitest';

import { useKeptEdits } from './features/plan/lasting';
import { startWords } from './i18n';
import { useLive } from './live/store';
import { useSelectionStore } from './state/selection';
import { useToasts } from './state/toasts';

class NoObserver {
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
  window.ResizeObserver ??= NoObserver as unknown as typeof ResizeObserver;
  window.IntersectionObserver ??= NoObserver as unknown as typeof IntersectionObserver; // nothing is in sight
  await startWords('en');
});

beforeEach(() => {
  localStorage.clear();
  useLive.setState(useLive.getInitialState(), true);
  useSelectionStore.setState(useSelectionStore.getInitialState(), true);
  useKeptEdits.setState({}, true);
  useToasts.setState(useToasts.getInitialState(), true);
});

afterEach(cleanup);
