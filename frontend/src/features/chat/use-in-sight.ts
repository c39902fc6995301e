import { useEffect, useState } from 'react';

/** Nearly all of it: a line that is cut off is not read. */
const WHOLE = 0.95;

/** Whether what was said can be read in the conversation now. */
export function useInSight(id: string): boolean {
  const [isSeen, setSeen] = useState(false);
  useEffect(() => {
    const said = document.querySelector(`[data-entry="${CSS.escape(id)}"]`);
    if (!said) return undefined;
    const look = new IntersectionObserver((seen) => setSeen((seen.at(-1)?.intersectionRatio ?? 0) >= WHOLE), { threshold: [0, WHOLE] });
    look.observe(said);
    return () => look.disconnect();
  }, [id]);
  return id !== '' && isSeen;
}
