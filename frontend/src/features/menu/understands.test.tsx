import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { ModelNote } from './understands';

it('offers a model that is here with how to use it, until that was put away; not where one is used', async () => {
  const asked: Asked[] = [];
  vi.stubGlobal('fetch', network({ models: { json: [{ language: 'auto:ollama:qwen3:8b', found: 'Ollama' }] } }, asked));
  const plain = snapshot();
  useLive.getState().takeSnapshot({ ...plain, info: { ...plain.info, offline_language: false } });
  const user = userEvent.setup();
  const { unmount } = render(<ModelNote />);
  expect(asked).toEqual([]);
  unmount();
  useLive.getState().takeSnapshot(plain);
  render(<ModelNote />);
  await screen.findByText(/qwen3:8b \(Ollama\)\. It is not used/);
  screen.getByText('--language auto:ollama:qwen3:8b');
  await user.click(screen.getByRole('button', { name: 'Not now' }));
  expect(screen.queryByText(/Ollama/)).toBeNull();
});
