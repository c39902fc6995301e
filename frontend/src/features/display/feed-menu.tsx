import { Checkbox, CheckboxGroup, DialogTrigger, Label, Popover } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import type { FeedInfo } from '@/live/types';
import { Button } from '@/ui/button';
import { Icon } from '@/ui/icon';

import css from './feed-menu.module.css';
import { isShown, useFeedChoice } from './shown-feeds';
import { useFeedName } from './use-feed-name';

/** Picks feeds, grouped by robot. */
export function FeedMenu({ groups }: { groups: readonly [string, readonly FeedInfo[]][] }) {
  const { t } = useTranslation('display');
  const choose = useFeedChoice((state) => state.choose);
  const all = groups.flatMap(([, feeds]) => feeds);
  return (
    <DialogTrigger>
      <Button tone="quiet" icon="down" isDisabled={all.length === 0}>
        {t('choose')}
      </Button>
      <Popover className={css.popover ?? ''} placement="bottom end" aria-label={t('chooseLabel')}>
        <div className={css.menu}>
          {groups.map(([robot, feeds]) => (
            <RobotFeeds key={robot} robot={robot} feeds={feeds} />
          ))}
          <div className={css.foot}>
            <Button onPress={() => choose(all, true)}>{t('all')}</Button>
            <Button onPress={() => choose(all, false)}>{t('nothing')}</Button>
          </div>
        </div>
      </Popover>
    </DialogTrigger>
  );
}

function RobotFeeds({ robot, feeds }: { robot: string; feeds: readonly FeedInfo[] }) {
  const { choice, choose } = useFeedChoice();
  const shown = feeds.filter((feed) => isShown(feed, choice)).map((feed) => feed.name);
  return (
    <CheckboxGroup
      className={css.group ?? ''}
      value={shown}
      onChange={(names) => {
        const changed = feeds.filter((feed) => names.includes(feed.name) !== shown.includes(feed.name));
        for (const feed of changed) choose([feed], names.includes(feed.name));
      }}
    >
      <Label className={css.robot ?? ''}>{robot}</Label>
      {feeds.map((feed) => (
        <FeedBox key={feed.name} name={feed.name} />
      ))}
    </CheckboxGroup>
  );
}

function FeedBox({ name }: { name: string }) {
  const label = useFeedName(name);
  return (
    <Checkbox value={name} className={css.box ?? ''}>
      <span className={css.mark}>
        <Icon name="check" size={18} />
      </span>
      {label}
    </Checkbox>
  );
}
