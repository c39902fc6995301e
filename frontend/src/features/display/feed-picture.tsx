import { useEffect, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { watchFeed } from '@/live/connection';
import type { FeedInfo } from '@/live/types';
import { inWords } from '@/ui/words';

import css from './display.module.css';

/** The newest picture of one feed. */
export function FeedPicture({ feed }: { feed: FeedInfo }) {
  const { t } = useTranslation('display');
  const { robot, name } = feed;
  const address = useNewestPicture(robot, name);
  return (
    <li className={css.feed}>
      <figure>
        {address ? (
          <img src={address} alt={t('alt', { name: inWords(name), robot })} />
        ) : (
          <p className={css.waiting}>{t('waiting')}</p>
        )}
        <figcaption>{t('label', { robot, name: inWords(name) })}</figcaption>
      </figure>
    </li>
  );
}

function useNewestPicture(robot: string, name: string): string {
  const [address, setAddress] = useState('');
  useEffect(() => {
    let shown = '';
    const stop = watchFeed({ robot, name }, (picture) => {
      const next = URL.createObjectURL(picture);
      setAddress(next);
      if (shown) URL.revokeObjectURL(shown);
      shown = next;
    });
    return () => {
      stop();
      if (shown) URL.revokeObjectURL(shown);
    };
  }, [robot, name]);
  return address;
}
