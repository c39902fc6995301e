import { beforeEach, expect, it } from 'vitest';

import { ApiError } from '@/live/api';
import { useLive } from '@/live/store';

import { attempt } from './do';
import { useOutbox } from './outbox';
import { useToasts } from './toasts';

const shown = () => useToasts.getState().toasts.map((toast) => toast.message);
const refuse = (message: string) => attempt(() => Promise.reject(new ApiError(409, message)));

beforeEach(() => useToasts.setState({ toasts: [] }));

it('stands only until the person does something else, when it is about what they did', async () => {
  await refuse('That plan is over.');
  expect(shown()).toEqual(['That plan is over.']);
  await refuse('Nobody is there.');
  expect(shown()).toEqual(['Nobody is there.']);
  await attempt(() => Promise.resolve());
  expect(shown()).toEqual([]);
});

it('goes also when the next thing is said instead of pressed; what else is true stays', async () => {
  useToasts.getState().show({ tone: 'error', message: 'Ada still waits for you.', stands: () => true });
  await refuse('That plan is over.');
  void useOutbox.getState().send({ text: 'go on', targets: ['Ada'], reply_to: '', images: [] });
  expect(shown()).toEqual(['Ada still waits for you.']);
});

it('goes when the server is reached again, whenever it was that the connection was lost', async () => {
  for (const isKnown of [true, false]) {
    useLive.setState({ connection: isKnown ? 'lost' : 'connected' });
    await attempt(() => Promise.reject(new ApiError(0, '')));
    expect(shown()).toHaveLength(1);
    if (!isKnown) useLive.setState({ connection: 'lost' });
    useLive.setState({ connection: 'connected' });
    expect(shown()).toEqual([]);
  }
});
