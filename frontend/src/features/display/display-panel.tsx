import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import { feedKey } from '@/live/world';
import { Empty, Panel } from '@/ui/panel';

import css from './display.module.css';
import { FeedPicture } from './feed-picture';

/** What robots see, and pictures they keep for people. */
export function DisplayPanel() {
  const { t } = useTranslation('display');
  const feeds = useWorld((world) => world.feeds);
  const shown = Object.values(feeds).sort((a, b) => feedKey(a).localeCompare(feedKey(b)));
  return (
    <Panel title={t('title')}>
      {shown.length === 0 ? (
        <Empty title={t('empty')}>
          <p>{t('emptyText')}</p>
        </Empty>
      ) : (
        <ul className={css.grid}>
          {shown.map((feed) => (
            <FeedPicture key={feedKey(feed)} feed={feed} />
          ))}
        </ul>
      )}
    </Panel>
  );
}
