import { act, render, screen } from '@testing-library/react';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';

import { entry } from '@/live/samples';

import { Thinking } from './thinking';

const SAID_MS = 100_000;
const said = entry({ id: 'm', who: 'operator', type: 'request', unix_ms: SAID_MS });
const words = () => screen.queryByText('Ada is working out what you mean');
const after = (ms: number) => act(() => vi.advanceTimersByTime(ms));

beforeEach(() => void vi.useFakeTimers({ now: SAID_MS }));
afterEach(() => void vi.useRealTimers());

it('says after half a second that words are worked out, until there is an answer', () => {
  const { rerender } = render(<Thinking last={said} />);
  after(400);
  expect(words()).toBeNull();
  after(200);
  expect(words()).not.toBeNull();
  rerender(<Thinking last={entry({ id: 'a' })} />);
  expect(words()).toBeNull();
});

it('says so no longer when none will come, and not of what was said long ago or answers a question', () => {
  const { rerender } = render(<Thinking last={said} />);
  after(30_000);
  expect(words()).toBeNull();
  rerender(<Thinking last={{ ...said, id: 'old' }} />);
  after(600);
  expect(words()).toBeNull();
  rerender(<Thinking last={{ ...said, id: 'new', type: 'response', unix_ms: Date.now() }} />);
  after(600);
  expect(words()).toBeNull();
});
