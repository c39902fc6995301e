import { useDeferredValue, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { searchMemories } from '@/live/api';
import { useWorld } from '@/live/store';
import type { MemoryItem } from '@/live/types';
import { useRobotNames } from '@/state/selection';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty, Loading, Panel } from '@/ui/panel';
import { TextField } from '@/ui/text-field';
import { useHashValue } from '@/ui/use-hash';
import { useKept, useRequest } from '@/ui/use-request';

import { MemoryCard } from './memory-card';
import { MemoryEditor, type Editing } from './memory-editor';
import css from './memory.module.css';

const DRAWN_AT_ONCE = 60;
const EVERYTHING = '*';

/** What is remembered: to look through, correct, add to and forget. */
export function MemoryPage() {
  const { t } = useTranslation(['memory', 'common']);
  const [words, setWords] = useState(useHashValue('name').replaceAll('_', ' '));
  const [scope, setScope] = useState(EVERYTHING);
  const [editing, setEditing] = useState<Editing | null>(null);
  const names = useRobotNames();
  const changes = useWorld((world) => world.memoryChanges);
  const sought = useDeferredValue(words.trim());
  const [asked, setAsked] = useState(0);
  const found = useKept(
    useRequest([changes, asked, scope, sought].join('\n'), () => searchMemories(sought, scope === EVERYTHING ? '' : scope)),
  );
  const scopes = [{ id: EVERYTHING, label: t('everything') }, ...names.map((name) => ({ id: name, label: t('knownTo', { name }) }))];
  const add = (
    <Button needs="remember" tone="quiet" icon="plus" onPress={() => setEditing({ item: null })}>
      {t('add')}
    </Button>
  );
  return (
    <Panel title={t('title')} tools={add}>
      <div className={css.page}>
        <div className={css.search} role="search">
          <TextField label={t('search')} value={words} onChange={setWords} maxLength={500} />
          {names.length > 0 && <Choice label={t('whose')} value={scope} options={scopes} onChange={setScope} />}
        </div>
        {found.state === 'loading' && <Loading />}
        {found.state === 'failed' && (
          <Empty title={t('failed')}>
            <p role="alert">{found.reason}</p>
            <Button onPress={() => setAsked(asked + 1)}>{t('common:tryAgain')}</Button>
          </Empty>
        )}
        {found.state === 'ready' && (
          <Found items={sought ? found.value : found.value.toReversed()} searched={sought !== ''} onEdit={setEditing} />
        )}
      </div>
      {editing && <MemoryEditor editing={editing} robots={names} onClose={() => setEditing(null)} />}
    </Panel>
  );
}

interface FoundProps {
  items: readonly MemoryItem[];
  searched: boolean;
  onEdit: (editing: Editing) => void;
}

function Found({ items, searched, onEdit }: FoundProps) {
  const { t } = useTranslation('memory');
  const [drawn, setDrawn] = useState(DRAWN_AT_ONCE);
  if (items.length === 0) return <Empty title={searched ? t('none') : t('empty')}>{!searched && <p>{t('emptyText')}</p>}</Empty>;
  return (
    <>
      <p className={css.count} role="status">
        {t('count', { count: items.length })}
      </p>
      <ul className={css.list}>
        {items.slice(0, drawn).map((item) => (
          <MemoryCard key={`${item.scope}\n${item.name}`} item={item} onEdit={() => onEdit({ item })} />
        ))}
      </ul>
      {items.length > drawn && <Button onPress={() => setDrawn(drawn + DRAWN_AT_ONCE)}>{t('more')}</Button>}
    </>
  );
}
