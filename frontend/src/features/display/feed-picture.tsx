import { useTranslation } from 'react-i18next';

import { onServerClock } from '@/live/server-time';
import type { FeedInfo } from '@/live/types';
import { Icon } from '@/ui/icon';
import { useNow } from '@/ui/use-now';
import { ago } from '@/ui/words';

import css from './display.module.css';
import { isStale } from './shown-feeds';
import { useFeedName } from './use-feed-name';
import { useFilm } from './use-film';

interface Props {
  feed: FeedInfo;
  /** Show it as large as the screen; without it the picture fills its place. */
  onEnlarge?: () => void;
}

const AGE_STEP_MS = 1000;

/** The newest picture of one feed, and how old it is. */
export function FeedPicture({ feed, onEnlarge }: Props) {
  const { t, i18n } = useTranslation('display');
  const name = useFeedName(feed.name);
  const now = useNow(AGE_STEP_MS);
  const { takenUnixMs, screen } = useFilm(feed.robot, feed.name);
  const has = takenUnixMs !== null;
  const taken = takenUnixMs || feed.last_unix_ms;
  const ageMs = taken > 0 ? Math.max(0, onServerClock(now) - taken) : 0;
  const stale = has && isStale(feed, ageMs);
  const shown = has ? (
    <canvas ref={screen} role="img" aria-label={t('alt', { name, robot: feed.robot })} />
  ) : (
    <span className={css.waiting}>{t('waiting')}</span>
  );
  return (
    <figure className={css.feed} data-stale={stale}>
      <div className={css.frame}>
        {onEnlarge && has ? (
          <button type="button" className={css.enlarge} onClick={onEnlarge} aria-label={t('enlarge', { name, robot: feed.robot })}>
            {shown}
            <span className={css.corner}>
              <Icon name="enlarge" size={18} />
            </span>
          </button>
        ) : (
          shown
        )}
        {stale && <span className={css.stale}>{t('stale', { ago: ago(ageMs, i18n.language) })}</span>}
      </div>
      <figcaption>
        <strong>{feed.robot}</strong> <span>{name}</span>
        {has && taken > 0 && !stale && <Freshness live={feed.continuous} ageMs={ageMs} />}
      </figcaption>
    </figure>
  );
}

function Freshness({ live, ageMs }: { live: boolean; ageMs: number }) {
  const { t, i18n } = useTranslation('display');
  if (!live) return <span className={css.age}>{ago(ageMs, i18n.language)}</span>;
  return (
    <span className={css.live}>
      <span aria-hidden="true" />
      {t('live')}
    </span>
  );
}
