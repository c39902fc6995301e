import { describe, expect, it } from 'vitest';

import { languages } from '.';

type Tree = { [key: string]: string | Tree };

const flat = (tree: Tree, before = ''): [string, string][] =>
  Object.entries(tree).flatMap(([key, value]) =>
    typeof value === 'string' ? [[before + key, value] as [string, string]] : flat(value, `${before}${key}.`),
  );

const places = (text: string) => [...text.matchAll(/{{(\w+)}}/g)].map((match) => match[1]).sort();

describe('the words of the page', () => {
  const english = new Map(flat(languages.en as unknown as Tree));
  const others = Object.entries(languages).filter(([name]) => name !== 'en');

  it.each(others)('are there in the language %s', (_, words) => {
    const other = new Map(flat(words as unknown as Tree));
    expect([...other.keys()].sort()).toEqual([...english.keys()].sort());
  });

  it.each(others)('name the same things in the language %s', (_, words) => {
    const known = new Map(flat(words as unknown as Tree));
    const different = [...english].filter(([key, text]) => {
      const other = known.get(key) ?? '';
      return places(text).join() !== places(other).join();
    });
    expect(different).toEqual([]);
  });

  it('are plain words', () => {
    const jargon = /\b(node|topic|graph|parameter|umrf|ros|websocket|socket|server|client|json|api|latch\w*|pose|yaw)\b/i;
    expect([...english].filter(([, text]) => jargon.test(text.replaceAll(/{{\w+}}/g, '')))).toEqual([]);
  });
});
