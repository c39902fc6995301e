import { useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useLive, useWorld } from '@/live/store';
import { feedKey } from '@/live/world';
import { useSelection } from '@/state/selection';
import { Empty, Loading, Panel } from '@/ui/panel';

import css from './display.module.css';
import { FeedMenu } from './feed-menu';
import { FeedPicture } from './feed-picture';
import { FullScreen } from './full-screen';
import { byRobot, isShown, useFeedChoice } from './shown-feeds';

/** What robots see, and pictures they keep for people. */
export function DisplayPanel() {
  const { t } = useTranslation(['display', 'common']);
  const feeds = useWorld((world) => world.feeds);
  const known = useLive((live) => live.world.run !== '');
  const choice = useFeedChoice((state) => state.choice);
  const [large, setLarge] = useState('');
  const chosen = useSelection();
  const groups = useMemo(() => byRobot(feeds, chosen), [feeds, chosen]);
  const shown = groups.flatMap(([, some]) => some.filter((feed) => isShown(feed, choice)));
  const enlarged = shown.find((feed) => feedKey(feed) === large);
  return (
    <Panel title={t('title')} tools={<FeedMenu groups={groups} />} flush>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys */}
      <div className={css.scroller} tabIndex={0} role="group" aria-label={t('title')}>
        {!known && <Loading />}
        {known && groups.length === 0 && (
          <Empty title={t('empty')}>
            <p>{t('emptyText')}</p>
          </Empty>
        )}
        {groups.length > 0 && shown.length === 0 && (
          <Empty title={t('noneChosen')}>
            <p>{t('noneChosenText')}</p>
          </Empty>
        )}
        <ul className={css.grid}>
          {shown.map((feed) => (
            <li key={feedKey(feed)}>
              <FeedPicture feed={feed} onEnlarge={() => setLarge(feedKey(feed))} />
            </li>
          ))}
        </ul>
      </div>
      {enlarged && (
        <FullScreen feeds={shown} feed={enlarged} onShow={(feed) => setLarge(feedKey(feed))} onClose={() => setLarge('')} />
      )}
    </Panel>
  );
}
