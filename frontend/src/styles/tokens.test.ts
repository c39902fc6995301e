import { readFileSync } from 'node:fs';

import { expect, it } from 'vitest';

const LEAST = 4.5; // WCAG 2.2 AA, for text of any size
const css = readFileSync('src/styles/tokens.css', 'utf8');
const looks = [...css.matchAll(/:root[^{]*\{([^{}]*--ink:[^}]*)\}/g)].map(([, block = '']) =>
  Object.fromEntries([...block.matchAll(/--([\w-]+): (#\w{6});/g)].map(([, name = '', colour = '']) => [name, colour])),
);

function brightness(colour: string): number {
  const [red = 0, green = 0, blue = 0] = [1, 3, 5].map((at) => {
    const part = parseInt(colour.slice(at, at + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrast(one: string, other: string): number {
  const [dark = 0, light = 0] = [brightness(one), brightness(other)].sort((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}

/** What is written on what: a colour on its own soft one, on that of its meaning, and words on every ground. */
function pairs(look: Record<string, string>): [string, string][] {
  const grounds = ['page', 'surface', 'surface-2', 'hover', 'mine', ...Object.keys(look).filter((name) => name.endsWith('-soft'))];
  const own = Object.keys(look).flatMap((name): [string, string][] => {
    const word = name.slice(0, -5);
    if (name.endsWith('-soft') && look[word]) return word === 'danger' ? [] : [[word, name]]; // that one is a ground only
    return name.endsWith('-ink') ? [[name, name.slice(0, -4)]] : [];
  });
  return [...own, ...grounds.flatMap((ground): [string, string][] => [['ink', ground], ['ink-2', ground]])];
}

it('can be read: every colour of words on every ground it stands on, in each look', () => {
  expect(looks).toHaveLength(4);
  const faint = looks.flatMap((look, number) =>
    pairs(look)
      .map(([word, ground]) => `${number}: ${word} on ${ground} ${contrast(look[word] ?? '', look[ground] ?? '').toFixed(2)}`)
      .filter((line) => Number(line.split(' ').at(-1)) < LEAST),
  );
  expect(faint).toEqual([]);
});
