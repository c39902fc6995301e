import { useDeferredValue, useState, type ReactNode } from 'react';
import { useTranslation } from 'react-i18next';

import { useRobotNames } from '@/state/selection';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty, Loading } from '@/ui/panel';
import { TextField } from '@/ui/text-field';
import type { Loaded } from '@/ui/use-request';

import css from './log.module.css';

const ALL = '*';

/** By which words, which person and which robot a list is narrowed down, and how far back it is shown. */
export function useNarrowing() {
  const [words, setWords] = useState('');
  const [who, setWho] = useState('');
  const [robot, setRobot] = useState(ALL);
  const [before, setBefore] = useState(0);
  /** Another wish begins with the newest again. */
  const anew =
    <T,>(set: (value: T) => void) =>
    (value: T) => {
      set(value);
      setBefore(0);
    };
  const wish = {
    q: useDeferredValue(words.trim()),
    by: useDeferredValue(who.trim()),
    robot: robot === ALL ? '' : robot,
    before,
  };
  return { words, setWords, who, setWho, robot, setRobot, setBefore, anew, wish, narrowed: Boolean(wish.q || wish.by || wish.robot) };
}

type Narrowing = ReturnType<typeof useNarrowing>;

/** The fields for it; `children` are those that only one list has. */
export function NarrowBy({ by, label, children }: { by: Narrowing; label: string; children: ReactNode }) {
  const { t } = useTranslation('log');
  const names = useRobotNames();
  return (
    <div className={css.search} role="search">
      <TextField label={label} value={by.words} onChange={by.anew(by.setWords)} maxLength={200} />
      <TextField label={t('who')} value={by.who} onChange={by.anew(by.setWho)} maxLength={200} />
      {names.length > 1 && (
        <Choice
          label={t('whose')}
          value={by.robot}
          options={[{ id: ALL, label: t('all') }, ...names.map((name) => ({ id: name, label: name }))]}
          onChange={by.anew(by.setRobot)}
        />
      )}
      {children}
    </div>
  );
}

/** To what is older than the last one shown, and back. */
export function Paging({ by, complete, last }: { by: Narrowing; complete: boolean; last: number | undefined }) {
  const { t } = useTranslation('log');
  return (
    <>
      {by.wish.before > 0 && <Button onPress={() => by.setBefore(0)}>{t('newest')}</Button>}
      {!complete && <Button onPress={() => by.setBefore(last ?? 0)}>{t('older')}</Button>}
    </>
  );
}

/** What came, or that it is still to come, or that it did not and why. */
export function Shown<T>({ found, onAgain, children }: { found: Loaded<T>; onAgain: () => void; children: (value: T) => ReactNode }) {
  const { t } = useTranslation(['log', 'common']);
  if (found.state === 'loading') return <Loading />;
  if (found.state === 'ready') return children(found.value);
  return (
    <Empty title={t('failed')}>
      <p role="alert">{found.reason}</p>
      <Button onPress={onAgain}>{t('common:tryAgain')}</Button>
    </Empty>
  );
}
