import { Dialog, Modal, ModalOverlay } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import type { FeedInfo } from '@/live/types';
import { feedKey } from '@/live/world';
import { Button } from '@/ui/button';
import { StopButton } from '@/ui/stop-button';

import { FeedPicture } from './feed-picture';
import css from './full-screen.module.css';
import { useFeedName } from './use-feed-name';

interface Props {
  /** What can be leafed through. */
  feeds: readonly FeedInfo[];
  feed: FeedInfo;
  onShow: (feed: FeedInfo) => void;
  onClose: () => void;
}

const step = { ArrowLeft: -1, ArrowRight: 1 } as const;

/** One feed as large as the screen; stopping stays in reach. */
export function FullScreen({ feeds, feed, onShow, onClose }: Props) {
  const { t } = useTranslation(['display', 'common']);
  const name = useFeedName(feed.name);
  const several = feeds.length > 1;
  const leaf = (by: number) => {
    const at = feeds.findIndex((other) => feedKey(other) === feedKey(feed));
    const next = feeds[(at + by + feeds.length) % feeds.length];
    if (next) onShow(next);
  };
  return (
    <ModalOverlay
      isOpen
      isDismissable
      className={css.overlay ?? ''}
      onOpenChange={(open) => {
        if (!open) onClose();
      }}
    >
      <Modal className={css.modal ?? ''}>
        <Dialog className={css.dialog ?? ''} aria-label={t('alt', { name, robot: feed.robot })}>
          {/* eslint-disable-next-line jsx-a11y/no-static-element-interactions -- the same is done by the two buttons */}
          <div
            className={css.body}
            onKeyDown={(event) => {
              if (several && (event.key === 'ArrowLeft' || event.key === 'ArrowRight')) leaf(step[event.key]);
            }}
          >
            <header className={css.head}>
              {several && <Button icon="left" iconOnly aria-label={t('previous')} onPress={() => leaf(-1)} />}
              {several && <Button icon="right" iconOnly aria-label={t('next')} onPress={() => leaf(1)} />}
              <span className={css.space} />
              <StopButton />
              <Button icon="close" iconOnly autoFocus aria-label={t('common:close')} onPress={onClose} />
            </header>
            <FeedPicture key={feedKey(feed)} feed={feed} />
          </div>
        </Dialog>
      </Modal>
    </ModalOverlay>
  );
}
