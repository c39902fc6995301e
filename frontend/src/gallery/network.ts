/** A server of prepared answers, for the gallery and for tests of what the page makes of them. */

/** What a request gets: an answer, a refusal in words, or nothing. */
export type Answer = { json: unknown } | { refused: string; status?: number } | 'never';

/** Beginning of the path below /api -> answer; the longest that fits counts. What is not only read needs its whole path. */
export type Answers = Readonly<Record<string, Answer>>;

export interface Asked {
  method: string;
  path: string;
  body: unknown;
}

const reply = (value: unknown, status = 200) => new Response(JSON.stringify(value), { status });

/** @param asked Gets each request. */
export function network(answers: Answers, asked: Asked[] = []): typeof fetch {
  return (input, options) => {
    const path = String(input).replace(/^\/api\//, '');
    const method = options?.method ?? 'GET';
    asked.push({ method, path, body: options?.body ? (JSON.parse(String(options.body)) as unknown) : null });
    const fitting = Object.keys(answers).filter((start) => path.startsWith(start) && (method === 'GET' || start === path));
    const answer = answers[fitting.sort((a, b) => b.length - a.length)[0] ?? ''] ?? { json: {} };
    if (answer === 'never') return new Promise<Response>(() => undefined);
    return Promise.resolve('refused' in answer ? reply({ detail: answer.refused }, answer.status ?? 503) : reply(answer.json));
  };
}
