/** The live connection: snapshot, then changes; after a break only what was missed. */
import { io, type Socket } from 'socket.io-client';

import { useLive } from './store';
import type { Change, MapView, Snapshot } from './types';

export interface FrameMeta {
  robot: string;
  name: string;
  type?: string;
  unix_ms?: number;
}

/** Shows a picture; what it returns is waited for before the next one is asked for. */
type FrameHandler = (picture: ArrayBuffer, meta: FrameMeta) => void | Promise<void>;

const REFUSED_DELAY_MS = 1000;

let socket: Socket | null = null;
const watchers = new Map<string, Set<FrameHandler>>();
/** The last picture of each feed that is looked at, for who looks at it as well. */
const newest = new Map<string, { picture: ArrayBuffer; meta: FrameMeta }>();

const keyOf = (feed: { robot: string; name: string }) => `${feed.robot}\n${feed.name}`;

/** In which language the world was told. */
let told = '';

/**
 * Connect, and stay connected.
 * @param language In which it is told what robots say.
 * @param onDoubt Called when it may have changed who this visitor is, or whether they are let in.
 * @returns How to hang up.
 */
export function connect(language: string, onDoubt: () => void): () => void {
  const live = () => useLive.getState();
  const opened = io({
    path: '/socket.io',
    transports: ['websocket', 'polling'],
    auth: (send) => send({ run: told === language ? live().world.run : '', since: live().world.seq, language }),
    reconnectionDelay: 500,
    reconnectionDelayMax: 4000,
    timeout: 8000,
  });
  socket = opened;
  // A server that hangs up or refuses, as one that is just ending does, is left alone by the library: we try again.
  let knock: ReturnType<typeof setTimeout> | undefined;
  const knockLater = () => {
    clearTimeout(knock);
    knock = setTimeout(() => opened.connect(), REFUSED_DELAY_MS);
  };
  opened.on('connect', () => {
    live().setConnection('connected');
    sendWatched();
  });
  opened.on('disconnect', (reason) => {
    live().setConnection('lost', Date.now());
    if (reason === 'io server disconnect') {
      onDoubt();
      knockLater();
    }
  });
  opened.on('connect_error', () => {
    if (live().connection !== 'lost') live().setConnection('lost', Date.now());
    onDoubt();
    if (!opened.active) knockLater();
  });
  opened.on('snapshot', (snapshot: Snapshot) => {
    told = language;
    live().takeSnapshot(snapshot);
  });
  opened.on('changes', (changes: Change[]) => live().takeChanges(changes));
  opened.on('view', (view: MapView) => live().takeView(view));
  opened.on('frame', onFrame);
  opened.on('session', onDoubt);
  document.addEventListener('visibilitychange', sendWatched);
  return () => {
    document.removeEventListener('visibilitychange', sendWatched);
    clearTimeout(knock);
    opened.removeAllListeners();
    opened.disconnect();
    socket = null;
  };
}

/** Try again at once instead of after the waiting time. */
export function reconnectNow(): void {
  socket?.disconnect().connect();
}

/** Receive the pictures of a feed. @returns How to end it. */
export function watchFeed(feed: { robot: string; name: string }, handler: FrameHandler): () => void {
  const key = keyOf(feed);
  const handlers = watchers.get(key) ?? new Set();
  handlers.add(handler);
  watchers.set(key, handlers);
  const last = newest.get(key);
  if (last) void handler(last.picture, last.meta);
  sendWatched();
  return () => {
    handlers.delete(handler);
    if (handlers.size === 0) {
      watchers.delete(key);
      newest.delete(key);
    }
    sendWatched();
  };
}

/** Tell what is looked at: nothing while the page is hidden, so that cameras can rest. */
function sendWatched(): void {
  if (!socket?.connected) return;
  const feeds = document.hidden ? [] : [...watchers.keys()].map((key) => {
    const [robot = '', name = ''] = key.split('\n');
    return { robot, name };
  });
  socket.emit('watch', feeds);
}

async function onFrame(meta: FrameMeta, picture: ArrayBuffer, acknowledge?: () => void): Promise<void> {
  const key = keyOf(meta);
  const handlers = [...(watchers.get(key) ?? [])];
  if (handlers.length > 0) newest.set(key, { picture, meta });
  await Promise.allSettled(handlers.map((handler) => handler(picture, meta)));
  acknowledge?.();
}
