/** The one place that holds what the server told. Components read slices of it with `useLive`. */
import { create } from 'zustand';

import type { Change, ChatEntry, MapView, Snapshot } from './types';
import { applyChanges, emptyWorld, fromSnapshot, mergeChat, type World } from './world';

/** `locked`: the server wants a password or code first. */
export type Connection = 'connecting' | 'connected' | 'lost' | 'locked';

interface Live {
  connection: Connection;
  /** When the connection was lost; 0 while it stands. */
  lostUnixMs: number;
  world: World;
  setConnection: (connection: Connection, unixMs?: number) => void;
  takeSnapshot: (snapshot: Snapshot) => void;
  takeChanges: (changes: readonly Change[]) => void;
  takeView: (view: MapView) => void;
  takeOlderChat: (entries: readonly ChatEntry[], complete: boolean) => void;
}

export const useLive = create<Live>()((set) => ({
  connection: 'connecting',
  lostUnixMs: 0,
  world: emptyWorld,
  setConnection: (connection, unixMs = 0) => set({ connection, lostUnixMs: unixMs }),
  takeSnapshot: (snapshot) => set((live) => ({ world: fromSnapshot(snapshot, live.world) })),
  takeChanges: (changes) => set((live) => ({ world: applyChanges(live.world, changes) })),
  takeView: (view) =>
    set((live) => ({ world: { ...live.world, views: { ...live.world.views, [view.actor]: view } } })),
  takeOlderChat: (entries, complete) =>
    set((live) => ({
      world: {
        ...live.world,
        chat: mergeChat(live.world.chat, entries),
        chatComplete: complete,
        chatFrom: complete ? 0 : Math.min(live.world.chatFrom, entries[0]?.seq ?? live.world.chatFrom),
      },
    })),
}));

/** A slice of the world; renders again only when that slice changes. */
export const useWorld = <T>(pick: (world: World) => T): T => useLive((live) => pick(live.world));
