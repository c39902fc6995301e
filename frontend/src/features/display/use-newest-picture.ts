import { useEffect, useState } from 'react';

import { watchFeed } from '@/live/connection';

export interface Picture {
  /** Given away when it is drawn; see `Drawn`. */
  bitmap: ImageBitmap;
  /** When it was taken, by the server's clock; 0 if that is not known. */
  unixMs: number;
  /** To be called once it is on the screen. */
  onShown: () => void;
}

/** The newest picture of a feed. It is read beside the page's own work; one that a newer overtook is let go of. */
export function useNewestPicture(robot: string, name: string): Picture | null {
  const [picture, setPicture] = useState<Picture | null>(null);
  useEffect(() => {
    let came = 0;
    let newest = 0;
    let ended = false;
    let letGo: () => void = () => undefined;
    const stop = watchFeed({ robot, name }, async (blob, meta) => {
      came += 1;
      const number = came;
      const bitmap = await createImageBitmap(blob);
      if (ended || number < newest) {
        bitmap.close();
        return;
      }
      newest = number;
      letGo();
      await new Promise<void>((resolve) => {
        letGo = () => {
          bitmap.close(); // does nothing to one that was drawn: that belongs to the canvas
          resolve();
        };
        setPicture({ bitmap, unixMs: meta.unix_ms ?? 0, onShown: resolve });
      });
    });
    return () => {
      ended = true;
      stop();
      letGo();
      setPicture(null);
    };
  }, [robot, name]);
  return picture;
}
