import { useTranslation } from 'react-i18next';

import { getMemoryHistory, putMemory } from '@/live/api';
import { useWorld } from '@/live/store';
import type { MemoryItem } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { useNow } from '@/ui/use-now';
import { useRequest } from '@/ui/use-request';
import { dayAndTime } from '@/ui/words';

import css from './memory.module.css';

const MINUTE_MS = 60_000;

/** What stood under a name before. */
export function MemoryHistory({ item }: { item: MemoryItem }) {
  const { t, i18n } = useTranslation(['memory', 'common']);
  const now = useNow(MINUTE_MS);
  const changes = useWorld((world) => world.memoryChanges);
  const earlier = useRequest([changes, item.scope, item.name].join('\n'), () => getMemoryHistory(item.name, item.scope));
  if (earlier.state === 'loading') return <p className={css.history}>{t('common:loading')}</p>;
  if (earlier.state === 'failed') return <p className={css.history} role="alert">{earlier.reason}</p>;
  if (earlier.value.length === 0) return <p className={css.history}>{t('noEarlier')}</p>;
  return (
    <ol className={css.history}>
      {earlier.value.toReversed().map((version, index) => (
        <li key={`${version.updated_unix_ms} ${index}`}>
          <time dateTime={new Date(version.updated_unix_ms).toISOString()}>
            {dayAndTime(version.updated_unix_ms, now, i18n.language)}
          </time>
          <p>{version.type === 'text' ? version.told || version.data : t('pictureThen')}</p>
          {version.type === 'text' && (
            <Button
              needs="remember"
              tone="quiet"
              icon="undo"
              onPress={() => void attempt(() => putMemory(item.name, { data: version.data, info: version.info, scope: item.scope }))}
            >
              {t('useAgain')}
            </Button>
          )}
        </li>
      ))}
    </ol>
  );
}
