import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import type { MemoryItem } from '@/live/types';
import { attempt } from '@/state/do';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';
import { useNow } from '@/ui/use-now';
import { ago, dayAndTime, inWords, quoted, sentence } from '@/ui/words';

import { MemoryHistory } from './memory-history';
import css from './memory.module.css';
import { forget, sourceOf, wayOf } from './remembering';

interface Props {
  item: MemoryItem;
  onEdit: () => void;
}

const MINUTE_MS = 60_000;

/** Words alone, to see whether two texts are the same. */
const bare = (text: string) => text.toLowerCase().match(/[\p{L}\p{N}]+/gu)?.join(' ');

/** One memory. */
export function MemoryCard({ item, onEdit }: Props) {
  const { t } = useTranslation(['memory', 'common']);
  const [history, setHistory] = useState(false);
  const show = useToasts((state) => state.show);
  const name = inWords(item.name);
  const onForget = () =>
    attempt(async () => {
      const restore = await forget(item);
      show({
        tone: 'info',
        message: t('forgotten', { name }),
        action: { label: t('common:undo'), run: () => void attempt(restore) },
      });
    });
  return (
    <li className={css.card}>
      <div className={css.what}>
        <h3>
          {name}
          {item.scope && <span className={css.scope}>{t('only', { name: item.scope })}</span>}
        </h3>
        {item.type === 'text' ? <p>{sentence(item.told || item.data)}</p> : <Picture item={item} />}
        <Origin item={item} />
      </div>
      <div className={css.deeds}>
        <Button tone="quiet" icon="clock" iconOnly aria-label={t('earlier', { name })} aria-expanded={history} onPress={() => setHistory(!history)} />
        {item.type === 'text' && <Button needs="remember" tone="quiet" icon="edit" iconOnly aria-label={t('correct', { name })} onPress={onEdit} />}
        <Button needs="forget" tone="quiet" icon="trash" iconOnly aria-label={t('forget', { name })} onPress={() => void onForget()} />
      </div>
      {history && <MemoryHistory item={item} />}
    </li>
  );
}

function Picture({ item }: { item: MemoryItem }) {
  return (
    <>
      <img src={item.data} alt={item.told || inWords(item.name)} loading="lazy" />
      {item.told && item.told !== item.name && <p>{sentence(item.told)}</p>}
    </>
  );
}

/** Where it came from, since when it stands, and when it was last of use. */
function Origin({ item }: { item: MemoryItem }) {
  const { t, i18n } = useTranslation('memory');
  const now = useNow(MINUTE_MS);
  const source = sourceOf(item);
  const words = {
    none: '',
    operator: t('from.operator'),
    someone: source.kind === 'someone' ? t('from.someone', { who: source.who }) : '',
    deed: source.kind === 'deed' ? t('from.deed', { who: source.who }) : '',
  }[source.kind];
  const way = wayOf(item);
  return (
    <p className={css.origin}>
      {way && <strong className={css.way}>{t(`way.${way}`)}</strong>}
      {words && way !== 'concluded' && <span>{words}</span>}
      {item.words && bare(item.words) !== bare(item.data) && <span>{t('inWords', { words: quoted(item.words) })}</span>}
      {item.updated_unix_ms > 0 && (
        <time dateTime={new Date(item.updated_unix_ms).toISOString()}>{dayAndTime(item.updated_unix_ms, now, i18n.language)}</time>
      )}
      <span>
        {item.used_count > 0
          ? t('used', { count: item.used_count, ago: ago(now - item.used_unix_ms, i18n.language) })
          : t('unused')}
      </span>
    </p>
  );
}
