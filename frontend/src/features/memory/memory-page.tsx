import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { searchMemories } from '@/live/api';
import { useWorld } from '@/live/store';
import { Empty, Panel } from '@/ui/panel';
import { TextField } from '@/ui/text-field';
import { useHashValue } from '@/ui/use-hash';
import { useRequest } from '@/ui/use-request';

import css from './memory.module.css';

/** What is remembered. */
export function MemoryPage() {
  const { t } = useTranslation(['memory', 'common']);
  const [words, setWords] = useState(useHashValue('name'));
  const changes = useWorld((world) => world.memoryChanges);
  const found = useRequest(`${changes}\n${words}`, () => searchMemories(words));
  return (
    <Panel title={t('title')}>
      <div className={css.page}>
        <TextField label={t('search')} value={words} onChange={setWords} />
        {found.state === 'loading' && <p>{t('common:loading')}</p>}
        {found.state === 'failed' && <p role="alert">{found.reason}</p>}
        {found.state === 'ready' && found.value.length === 0 && (
          <Empty title={words ? t('none') : t('empty')}>{!words && <p>{t('emptyText')}</p>}</Empty>
        )}
        {found.state === 'ready' && (
          <ul className={css.list}>
            {found.value.map((item) => (
              <li key={`${item.scope}\n${item.name}`}>
                <strong>{item.name}</strong>
                {item.type === 'text' ? <p>{item.data}</p> : <img src={item.data} alt={item.info || item.name} />}
              </li>
            ))}
          </ul>
        )}
      </div>
    </Panel>
  );
}
