import { act, render, screen } from '@testing-library/react';
import { afterEach, expect, it } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { usePrefs } from '@/state/prefs';

import { ChatPanel } from './chat-panel';

afterEach(() => usePrefs.setState({ language: 'en' }));

it('says where one writes that orders are understood in another language than one reads, whatever was said already', () => {
  const told = (offline_language: boolean) => {
    const plain = snapshot({ robots: [robot({ name: 'Ada' })] });
    act(() => useLive.getState().takeSnapshot({ ...plain, info: { ...plain.info, offline_language } }));
  };
  const note = () => screen.queryByText(/^Please write orders in English\./);
  told(true);
  render(<ChatPanel />);
  expect(note()).toBeNull();
  act(() => usePrefs.setState({ language: 'et' }));
  expect(note()).not.toBeNull();
  expect(screen.getByRole('link', { name: 'What can be done' }).getAttribute('href')).toContain('/settings');
  told(false); // a model understands it
  expect(note()).toBeNull();
});
