import { useTranslation } from 'react-i18next';

import { getLog } from '@/live/api';
import { Icon } from '@/ui/icon';
import { useNow } from '@/ui/use-now';
import { useRequest } from '@/ui/use-request';
import { timeOrDay } from '@/ui/words';

import css from './log.module.css';

const MINUTE_MS = 60_000;

/** Whether the log is as it was written. */
export function ChainMark({ asked }: { asked: string }) {
  const { t, i18n } = useTranslation('log');
  const now = useNow(MINUTE_MS);
  const found = useRequest(asked, () => getLog({ verify: true, limit: 1 }));
  const chain = found.state === 'ready' ? found.value.chain : null;
  if (!chain) return <span className={css.mark}>{found.state === 'loading' ? t('checking') : t('unchecked')}</span>;
  const broken = chain.problem !== '';
  return (
    <span className={css.mark} data-broken={broken} role="status">
      <Icon name={broken ? 'bang' : 'check'} size={16} />
      {broken
        ? t('broken', { number: chain.first_broken ?? 0 })
        : t('whole', { time: timeOrDay(chain.since_unix_ms ?? 0, now, i18n.language) })}
    </span>
  );
}
