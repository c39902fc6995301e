import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';

import { robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { answeredIn, useOutbox } from './outbox';

const keys: string[] = [];
let reachable = false;

beforeEach(() => {
  sessionStorage.clear();
  keys.length = 0;
  reachable = false;
  useOutbox.setState({ messages: [] });
  vi.stubGlobal('fetch', (_path: string, options: RequestInit) => {
    keys.push((JSON.parse(String(options.body)) as { id: string }).id);
    return reachable ? Promise.resolve(new Response('{}')) : Promise.reject(new TypeError('no network'));
  });
});

/** What a page that is loaded again begins with. */
async function loadAgain() {
  const kept = sessionStorage.getItem('parley.outbox') ?? '';
  useOutbox.setState({ messages: [] });
  sessionStorage.setItem('parley.outbox', kept);
  await useOutbox.persist.rehydrate();
}

describe('a message that did not get through', () => {
  it('can be sent again under the same key after the page was loaded again', async () => {
    await useOutbox.getState().send({ text: 'come here', targets: ['Ada'], reply_to: '', images: [] });
    await loadAgain();
    const [message] = useOutbox.getState().messages;
    expect(message).toMatchObject({ text: 'come here', state: 'failed' });
    reachable = true;
    await useOutbox.getState().retry(message?.id ?? '');
    expect(keys).toEqual([message?.id, message?.id]);
    expect(useOutbox.getState().messages).toMatchObject([{ state: 'sent' }]);
  });

  it('is known to be of no use as it is where it was refused, and only there', async () => {
    for (const [status, reply_to, refused] of [[409, 'q', true], [409, '', false], [422, '', true], [503, 'q', false]] as const) {
      useOutbox.setState({ messages: [] });
      vi.stubGlobal('fetch', () => Promise.resolve(new Response('{"detail": "no"}', { status })));
      await useOutbox.getState().send({ text: `try ${status}${reply_to}`, targets: ['Ada'], reply_to, images: [] });
      expect(useOutbox.getState().messages).toMatchObject([{ state: 'failed', refused }]);
    }
  });

  it('goes when something else is said, where it was an answer that came too late, and says why till then', async () => {
    const { send } = useOutbox.getState();
    vi.stubGlobal('fetch', () => Promise.resolve(new Response('{"detail": "Settled."}', { status: 409 })));
    await send({ text: 'the red one', targets: ['Ada'], reply_to: 'q', images: [] });
    await loadAgain();
    expect(useOutbox.getState().messages).toMatchObject([{ text: 'the red one', refused: true, reason: 'Settled.' }]);
    await send({ text: 'come here', targets: ['Ada'], reply_to: '', images: [] });
    expect(useOutbox.getState().messages).toMatchObject([{ text: 'come here' }]);
  });

  it('answers its question as long as it did not fail', async () => {
    await useOutbox.getState().send({ text: 'red', targets: ['Ada'], reply_to: 'q', images: [] });
    expect([...answeredIn(useOutbox.getState().messages)]).toEqual([]);
    reachable = true;
    await useOutbox.getState().send({ text: 'blue', targets: ['Ada'], reply_to: 'q', images: [] });
    expect([...answeredIn(useOutbox.getState().messages)]).toEqual(['q']);
  });

  it('is forgotten when it is discarded', async () => {
    await useOutbox.getState().send({ text: 'wave', targets: ['Ada'], reply_to: '', images: [] });
    useOutbox.getState().discard(useOutbox.getState().messages[0]?.id ?? '');
    await loadAgain();
    expect(useOutbox.getState().messages).toEqual([]);
  });
});

describe('a stop that is written', () => {
  const write = (text: string) => void useOutbox.getState().send({ text, targets: ['Ada'], reply_to: '', images: [] });
  const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);

  beforeEach(() => {
    vi.useFakeTimers();
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
  });
  afterEach(() => vi.useRealTimers());

  it('is sent until it gets through, under one key, also by a page that was loaded again', async () => {
    for (const text of ['stop!', 'Ada, stop right there', 'Seis!']) {
      keys.length = 0;
      reachable = false;
      useOutbox.setState({ messages: [] });
      write(text);
      await wait(1600);
      if (text === 'stop!') await loadAgain();
      await wait(600);
      expect(useOutbox.getState().messages).toMatchObject([{ state: 'failed', insists: true }]);
      expect(keys.length).toBeGreaterThan(2);
      reachable = true;
      await wait(600);
      expect(useOutbox.getState().messages).toMatchObject([{ state: 'sent' }]);
      expect(new Set(keys).size).toBe(1);
      const taken = keys.length;
      await wait(5000);
      expect(keys.length).toBe(taken);
    }
  });

  it('is called off, and is late at once where nothing answers', async () => {
    write('stop');
    await wait(600);
    useOutbox.getState().discard(useOutbox.getState().messages[0]?.id ?? '');
    const tried = keys.length;
    await wait(5000);
    expect(keys.length).toBe(tried);
    vi.stubGlobal('fetch', () => new Promise(() => undefined));
    write('stop, Ada');
    await wait(800);
    expect(useOutbox.getState().messages).toMatchObject([{ state: 'failed' }]);
  });

  it('is nothing that says more, which must not arrive late', async () => {
    for (const text of ['stop at the large sofa for John', 'go to the kitchen', 'nonstop']) {
      write(text);
      await wait(600);
    }
    await wait(5000);
    expect(keys).toHaveLength(3);
  });
});

describe('what is pressed twice', () => {
  it('is said once, and an answer that is on its way stays the only one', async () => {
    reachable = true;
    const { send, discard } = useOutbox.getState();
    const order = { text: 'go there', targets: ['Ada'], reply_to: '', images: [] };
    await Promise.all([send(order), send(order)]);
    expect(keys).toHaveLength(1);
    await Promise.all([send({ ...order, text: 'look there' }), send({ ...order, targets: ['Ben'] })]);
    expect(keys).toHaveLength(3);
    const answer = { ...order, text: 'the box', reply_to: 'q1' };
    reachable = false;
    await send(answer);
    vi.spyOn(Date, 'now').mockReturnValue(Date.now() + 60_000);
    await send(answer); // the first one failed
    expect(keys).toHaveLength(5);
    discard(useOutbox.getState().messages.at(-1)?.id ?? '');
    await send(answer);
    expect(keys).toHaveLength(6);
    vi.restoreAllMocks();
  });
});
