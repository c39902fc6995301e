import { act, renderHook } from '@testing-library/react';
import { afterEach, expect, it, vi } from 'vitest';

import { entry, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { usePrefs } from '@/state/prefs';
import { useToasts } from '@/state/toasts';

import { AGAIN_MS, useHeard } from './use-heard';

const question = entry({ id: 'q', seq: 1, type: 'request', question: 'open', message: 'Which box?' });
const take = (seq: number, entries: (typeof question)[]) =>
  act(() => useLive.getState().takeChanges(entries.map((one, index) => ({ kind: 'chat', seq: seq + index, entry: one }))));

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it('makes a robot that waits heard, once more when nobody answers, and no longer than it waits', () => {
  vi.useFakeTimers();
  const notes: string[] = [];
  const told = function (_title: string, { body }: { body: string }) {
    notes.push(body);
  };
  vi.stubGlobal('Notification', Object.assign(told, { permission: 'granted' }));
  vi.spyOn(document, 'hidden', 'get').mockReturnValue(true);
  usePrefs.setState({ loud: true });
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })], chat: [question] }));
  renderHook(useHeard);
  expect([document.title, notes]).toEqual(['(1) Parley', []]); // what waits already when the page is opened is seen
  take(1, [{ ...question, id: 'q2', seq: 2 }]);
  expect([document.title, notes]).toEqual(['(2) Parley', ['Ada waits for you.']]);
  act(() => vi.advanceTimersByTime(AGAIN_MS));
  expect(useToasts.getState().toasts.map((toast) => toast.message)).toEqual(['Ada still waits for you.']);
  expect(notes).toHaveLength(2);
  take(3, [{ ...question, question: 'answered' }, { ...question, id: 'q2', seq: 2, question: 'answered' }]);
  expect([document.title, useToasts.getState().toasts]).toEqual(['Parley', []]);
  act(() => vi.advanceTimersByTime(2 * AGAIN_MS));
  expect(notes).toHaveLength(2);
});

it('shows the note of its worker on a phone, where a page may make none itself', async () => {
  const notes: unknown[] = [];
  const refused = () => {
    throw new TypeError('Illegal constructor');
  };
  vi.stubGlobal('Notification', Object.assign(refused, { permission: 'granted' }));
  vi.stubGlobal('navigator', {
    ...navigator,
    serviceWorker: { getRegistration: () => Promise.resolve({ showNotification: (...told: unknown[]) => Promise.resolve(notes.push(told)) }) },
  });
  vi.spyOn(document, 'hidden', 'get').mockReturnValue(true);
  usePrefs.setState({ loud: true });
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
  renderHook(useHeard);
  take(1, [question]);
  await vi.waitFor(() => expect(notes).toEqual([['Parley', { body: 'Ada waits for you.', tag: 'Parley' }]]));
});
