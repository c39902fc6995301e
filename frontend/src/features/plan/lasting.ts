/** What somebody is changing: it outlives that its part of the page goes for a while, and goes with the page. */
import { useState } from 'react';
import { create } from 'zustand';

export const useKeptEdits = create<Readonly<Record<string, unknown>>>()(() => ({}));

/** As `useState`, under a name. */
export function useLasting<T>(name: string, initial: T): [T, (value: T) => void] {
  const [first] = useState(initial);
  const kept = useKeptEdits((all) => all[name]);
  return [kept === undefined ? first : (kept as T), (value) => useKeptEdits.setState({ [name]: value })];
}

/** Forget all names that begin so. */
export function forget(beginning: string): void {
  const left = Object.entries(useKeptEdits.getState()).filter(([name]) => !name.startsWith(beginning));
  useKeptEdits.setState(Object.fromEntries(left), true);
}
