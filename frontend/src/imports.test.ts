import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, relative, resolve } from 'node:path';

import { describe, expect, it } from 'vitest';

const root = resolve(import.meta.dirname);

const filesIn = (folder: string): string[] =>
  readdirSync(folder).flatMap((name) => {
    const path = join(folder, name);
    if (statSync(path).isDirectory()) return filesIn(path);
    return /\.tsx?$/.test(name) && !name.includes('.test.') ? [path] : [];
  });

/** The file that an import names, or null for a library or a style sheet. */
function target(from: string, named: string): string | null {
  if (!named.startsWith('.') && !named.startsWith('@/')) return null;
  const base = named.startsWith('@/') ? join(root, named.slice(2)) : join(dirname(from), named);
  return ['.ts', '.tsx', '/index.ts', '/index.tsx'].map((end) => base + end).find((path) => existsSync(path)) ?? null;
}

/** What a file needs when it runs: types are gone by then. */
function importsOf(file: string): string[] {
  const found = readFileSync(file, 'utf8').matchAll(/(?:^|\n)(?:import|export)\s+(?!type\b)(?:[^'";]*?from\s+)?'([^']+)'/g);
  return [...found].flatMap((match) => target(file, match[1] ?? '') ?? []);
}

/** The first way round that is found from each file, as a list of files that begins and ends with the same one. */
function cycles(graph: ReadonlyMap<string, readonly string[]>): string[][] {
  const done = new Set<string>();
  const found: string[][] = [];
  const visit = (file: string, path: readonly string[]) => {
    const at = path.indexOf(file);
    if (at >= 0) found.push([...path.slice(at), file]);
    if (at >= 0 || done.has(file)) return;
    for (const next of graph.get(file) ?? []) visit(next, [...path, file]);
    done.add(file);
  };
  for (const file of graph.keys()) visit(file, []);
  return found;
}

describe('imports', () => {
  const graph = new Map(filesIn(root).map((file) => [file, importsOf(file)]));

  it('are found', () => {
    expect(graph.get(join(root, 'main.tsx'))).toContain(join(root, 'app/app.tsx'));
  });

  it('go nowhere round in a circle', () => {
    expect(cycles(graph).map((path) => path.map((file) => relative(root, file)).join(' -> '))).toEqual([]);
  });

  it('are noticed when they do', () => {
    expect(cycles(new Map([['a', ['b']], ['b', ['c']], ['c', ['b']]]))).toEqual([['b', 'c', 'b']]);
  });
});
