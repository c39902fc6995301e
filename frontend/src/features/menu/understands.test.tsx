import { act, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { expect, it, vi } from 'vitest';
import { navigate } from 'wouter/use-browser-location';

import { network, type Asked } from '@/gallery/network';
import { snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { ModelNote, Models } from './understands';

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
  act(() => navigate('/settings'));
  expect(screen.queryByText(/Ollama/)).toBeNull();
  act(() => navigate('/'));
  await screen.findByText(/qwen3:8b \(Ollama\)\. It is not used/);
  screen.getByText('--language auto:ollama:qwen3:8b');
  await user.click(screen.getByRole('button', { name: 'Not now' }));
  expect(screen.queryByText(/Ollama/)).toBeNull();
});

it('puts a model in use with one tap where that can be done, one of a key by its name, and takes it back', async () => {
  const asked: Asked[] = [];
  const offers = [
    { language: 'auto:ollama:qwen3:8b@http://127.0.0.1:9/v1', found: 'Ollama' },
    { language: 'auto:openai:', found: 'OPENAI_API_KEY' },
  ];
  vi.stubGlobal('fetch', network({ models: { json: offers } }, asked));
  const plain = snapshot();
  const told = (info: object) => useLive.getState().takeSnapshot({ ...plain, info: { ...plain.info, can_choose_language: true, ...info } });
  told({});
  const user = userEvent.setup();
  render(<Models />);
  await screen.findByText(/here: qwen3:8b \(Ollama\)/);
  const [local, key] = screen.getAllByRole('button', { name: 'Use it' });
  await user.click(local as HTMLElement);
  expect((key as HTMLButtonElement).disabled).toBe(true);
  await user.type(screen.getByRole('textbox', { name: 'Name of the model of openai' }), 'gpt-x');
  await user.click(key as HTMLElement);
  told({ offline_language: false, is_language_chosen: true });
  await user.click(await screen.findByRole('button', { name: 'Use again what was there first' }));
  const put = asked.filter(({ method }) => method === 'PUT').map(({ body }) => body);
  expect(put).toEqual([{ language: offers[0]?.language }, { language: 'auto:openai:gpt-x' }, { language: '' }]);
});
