import type { Mood } from '@/state/mood';

import css from './dot.module.css';

/** How a robot fares, as a sign: told by form and colour; the word for it stands beside it. */
export function Dot({ mood }: { mood: Mood }) {
  return <span className={css.dot} data-mood={mood} aria-hidden="true" />;
}
