/** A language model that is found on this machine: offered, used when somebody says so, and taken out of use again. */
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';

import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, say, sizes, startStage, type Stage } from './stage';

const ANSWER = 'I would love to, but I can only drive and look.';
const UNSURE = 'Could you brighten my day a little?';

/** As Ollama speaks: which models there are, and one that always says the same. */
function ollama(asked: string[]): Server {
  return createServer((request, response) => {
    let text = '';
    request.on('data', (data: Buffer) => (text += data.toString()));
    request.on('end', () => {
      asked.push(request.url ?? '');
      if (request.url === '/api/tags') return response.end(JSON.stringify({ models: [{ name: 'qwen3:8b' }] }));
      const { model, tools } = JSON.parse(text) as { model: string; tools: { function: { name: string } }[] };
      const call = { name: tools[0]?.function.name, arguments: JSON.stringify({ message_response: ANSWER }) };
      const part = (delta: object, end: string | null) => {
        const choices = [{ index: 0, delta, finish_reason: end }];
        response.write(`data: ${JSON.stringify({ id: 'x', created: 1, model, object: 'chat.completion.chunk', choices })}\n\n`);
      };
      response.setHeader('Content-Type', 'text/event-stream');
      part({ role: 'assistant', content: null }, null);
      part({ tool_calls: [{ index: 0, id: 'c', type: 'function', function: call }] }, null);
      part({}, 'tool_calls');
      return response.end('data: [DONE]\n\n');
    });
  });
}

describe.skipIf(!hasBrowser)('a language model that is here', () => {
  const asked: string[] = [];
  const server = ollama(asked);
  let stage: Stage;

  beforeAll(async () => {
    await new Promise<void>((listening) => server.listen(0, '127.0.0.1', listening));
    process.env.OLLAMA_HOST = `127.0.0.1:${(server.address() as AddressInfo).port}`;
    stage = await startStage();
  });

  afterAll(async () => {
    delete process.env.OLLAMA_HOST;
    await stage.close();
    server.close();
  });

  it('is offered, used from one tap on, in every page, and no more from the next', async () => {
    const [page, other] = [await stage.open(sizes.desktop), await stage.open(sizes.phone, '#/settings')];
    await page.getByText(/here: qwen3:8b \(Ollama\)\. It is not used/).waitFor();
    expect(await barriers(page)).toEqual([]);
    await say(page, UNSURE);
    await page.locator('li[data-entry]').nth(1).waitFor();
    expect(asked).not.toContain('/v1/chat/completions');
    await page.getByRole('button', { name: 'Use it' }).click();
    await page.getByRole('link', { name: 'Understands: qwen3:8b (ollama)' }).waitFor();
    await say(page, UNSURE);
    await page.getByText(ANSWER).waitFor();
    await other.getByText('qwen3:8b (ollama)').waitFor();
    expect(await barriers(other)).toEqual([]);
    await other.getByRole('button', { name: 'Use again what was there first' }).tap();
    await page.getByRole('link', { name: /^Understands: built-in/ }).waitFor();
    await page.getByRole('link', { name: 'History' }).click();
    await page.getByRole('button', { name: 'Who did what' }).click();
    await page.getByText(/changed a setting: people are understood by qwen3:8b/).waitFor();
  });
});
