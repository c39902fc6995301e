import { act, render, screen } from '@testing-library/react';
import i18next, { type ParseKeys } from 'i18next';
import { afterEach, describe, expect, it, vi } from 'vitest';

import { languages } from '@/i18n';
import { snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { network } from './network';
import { stories } from './stories';

/** A word with the values it needs left open, as a pattern. */
const pattern = (key: string) => {
  const text = i18next.t(key as ParseKeys, { skipInterpolation: true }) as string;
  return new RegExp(text.replaceAll(/[.*+?^$()|[\]\\]/g, '\\$&').replaceAll(/{{\w+}}/g, '.*'));
};

describe.each(Object.keys(languages))('in the language %s', (language) => {
  afterEach(async () => {
    vi.unstubAllGlobals();
    await i18next.changeLanguage('en');
  });

  it.each(stories.map((story) => [story.name, story] as const))('there is the face: %s', async (_name, story) => {
    await act(() => i18next.changeLanguage(language));
    vi.stubGlobal('fetch', network(story.answers));
    if (story.snapshot) useLive.getState().takeSnapshot(snapshot(story.snapshot));
    render(story.part());
    expect((await screen.findAllByText(pattern(story.shows))).length).toBeGreaterThan(0);
  });
});
