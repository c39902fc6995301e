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
  const estonian = new Map(flat(languages.et as unknown as Tree));

  it('are there in every language', () => {
    expect([...estonian.keys()].sort()).toEqual([...english.keys()].sort());
  });

  it('name the same things in every language', () => {
    const different = [...english].filter(([key, text]) => {
      const other = estonian.get(key) ?? '';
      return places(text).join() !== places(other).join();
    });
    expect(different).toEqual([]);
  });

  it('are plain words', () => {
    const jargon = /\b(node|topic|graph|parameter|umrf|ros|websocket|socket|server|client|json|api|latch\w*|pose|yaw)\b/i;
    expect([...english].filter(([, text]) => jargon.test(text.replaceAll(/{{\w+}}/g, '')))).toEqual([]);
  });
});
