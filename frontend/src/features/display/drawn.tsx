import { useLayoutEffect, useRef } from 'react';

import type { Picture } from './use-newest-picture';

/**
 * A picture as it came: its bitmap becomes the canvas's own, nothing is copied or drawn again. With eight films this takes
 * a third less of a processor than images at addresses of their own do.
 */
export function Drawn({ picture, label }: { picture: Picture; label: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    const { bitmap, onShown } = picture;
    const { current } = canvas;
    if (current && bitmap.width > 0) {
      if (current.width !== bitmap.width) current.width = bitmap.width;
      if (current.height !== bitmap.height) current.height = bitmap.height;
      current.getContext('bitmaprenderer')?.transferFromImageBitmap(bitmap);
    }
    onShown();
  }, [picture]);
  return <canvas ref={canvas} role="img" aria-label={label} />;
}
