import { useSyncExternalStore } from 'react';
import { useHashLocation } from 'wouter/use-hash-location';

const split = (hash: string): [string, string] => {
  const at = hash.indexOf('?');
  return at < 0 ? [hash, ''] : [hash.slice(0, at), hash.slice(at + 1)];
};

/** The page's path from the address after `#`; what follows a `?` there is for the page itself. */
export function useHashPath(): ReturnType<typeof useHashLocation> {
  const [location, go] = useHashLocation();
  return [split(location)[0], go];
}
useHashPath.hrefs = (path: string) => `#${path}`;

const subscribe = (changed: () => void) => {
  window.addEventListener('hashchange', changed);
  return () => window.removeEventListener('hashchange', changed);
};

/** A value that a link gave the page, as in `#/memory?name=box_place`; empty if it gave none. */
export function useHashValue(name: string): string {
  const hash = useSyncExternalStore(subscribe, () => window.location.hash);
  return new URLSearchParams(split(hash)[1]).get(name) ?? '';
}

/** Go to another page, as a link would. */
export function goTo(path: string): void {
  window.location.hash = path;
}
