import { useEffect, useState } from 'react';

import { watchFeed } from '@/live/connection';

export interface Picture {
  address: string;
  /** When it was taken, by the server's clock; 0 if that is not known. */
  unixMs: number;
  /** To be called once it is on the screen, or cannot be. */
  onShown: () => void;
}

/** The newest picture of a feed; earlier ones are let go of as soon as the next one is on the screen. */
export function useNewestPicture(robot: string, name: string): Picture | null {
  const [picture, setPicture] = useState<Picture | null>(null);
  useEffect(() => {
    const held = new Set<string>();
    const waiting = new Set<() => void>();
    const stop = watchFeed({ robot, name }, (blob, meta) => {
      const address = URL.createObjectURL(blob);
      held.add(address);
      return new Promise<void>((resolve) => {
        const onShown = () => {
          waiting.delete(onShown);
          for (const other of held) {
            if (other === address) break;
            URL.revokeObjectURL(other);
            held.delete(other);
          }
          resolve();
        };
        // A newer picture takes the place of one that is still being read.
        for (const skipped of [...waiting]) skipped();
        waiting.add(onShown);
        setPicture({ address, unixMs: meta.unix_ms ?? 0, onShown });
      });
    });
    return () => {
      stop();
      for (const resolve of waiting) resolve();
      for (const address of held) URL.revokeObjectURL(address);
      setPicture(null);
    };
  }, [robot, name]);
  return picture;
}
