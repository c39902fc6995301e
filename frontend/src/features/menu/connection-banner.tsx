import { useTranslation } from 'react-i18next';

import { reconnectNow } from '@/live/connection';
import { useLive } from '@/live/store';
import { Button } from '@/ui/button';
import { clockTime } from '@/ui/words';

import css from './menu.module.css';

/** Says that what is seen may be old. */
export function ConnectionBanner() {
  const { t, i18n } = useTranslation('menu');
  const connection = useLive((live) => live.connection);
  const lost = useLive((live) => live.lostUnixMs);
  return (
    <div role="status">
      {connection === 'lost' && (
        <div className={css.lost}>
          <p>{t('lost', { time: clockTime(lost, i18n.language, true) })}</p>
          <Button onPress={reconnectNow}>{t('reconnect')}</Button>
        </div>
      )}
    </div>
  );
}
