/** The map of a robot; while there is no connection, the one that was seen last. */
import { useEffect } from 'react';

import { getMap } from '@/live/api';
import { useLive } from '@/live/store';
import type { MapInfo } from '@/live/types';

import { useRequest } from './use-request';

/** `sinceUnixMs`: since when the map may have changed unseen; 0: it is as it is now. */
export type Shown =
  | { state: 'loading' | 'connecting' }
  | { state: 'failed'; reason: string }
  | { state: 'ready'; map: MapInfo; sinceUnixMs: number };

/** The last map of each robot, for who comes back to it. */
const seen = new Map<string, { map: MapInfo; unixMs: number }>();

/**
 * @param mapName Another one is another map.
 * @param asked Counts how often a person asked to try again.
 */
export function useMap(robot: string, mapName: string, asked: number): Shown {
  const lost = useLive((live) => live.connection === 'lost');
  const lostUnixMs = useLive((live) => live.lostUnixMs);
  // After a break it is asked for anew.
  const loaded = useRequest(robot && !lost ? [robot, mapName, asked].join('\n') : '', () => getMap(robot));
  useEffect(() => {
    if (loaded.state === 'ready') seen.set(robot, { map: loaded.value, unixMs: Date.now() });
  }, [loaded, robot]);
  if (loaded.state === 'ready') return { state: 'ready', map: loaded.value, sinceUnixMs: 0 };
  const last = seen.get(robot);
  if (last && loaded.state === 'failed') return { state: 'ready', map: last.map, sinceUnixMs: last.unixMs };
  if (last) return { state: 'ready', map: last.map, sinceUnixMs: lost ? lostUnixMs : 0 };
  return lost ? { state: 'connecting' } : loaded;
}
