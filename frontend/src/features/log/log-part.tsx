import { useDeferredValue, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getLog, type LogWish } from '@/live/api';
import { useWorld } from '@/live/store';
import type { LogLine, LogPage as Found } from '@/live/types';
import { attempt } from '@/state/do';
import { useRobotNames } from '@/state/selection';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty, Loading } from '@/ui/panel';
import { TextField } from '@/ui/text-field';
import { useNow } from '@/ui/use-now';
import { useKept, useRequest, type Loaded } from '@/ui/use-request';
import { timeOrDay } from '@/ui/words';

import { sayAgain } from './again';
import { ChainMark } from './chain-mark';
import { kinds, type Kind } from './kinds';
import css from './log.module.css';
import { save, tableOf } from './table';

const ALL = '*';
const MINUTE_MS = 60_000;

/** Who did what: to look through, narrow down and trust. */
export function LogPart() {
  const { t, i18n } = useTranslation(['log', 'common']);
  const [words, setWords] = useState('');
  const [who, setWho] = useState('');
  const [robot, setRobot] = useState(ALL);
  const [kind, setKind] = useState<Kind>('any');
  const [before, setBefore] = useState(0);
  const [asked, setAsked] = useState(0);
  const names = useRobotNames();
  const run = useWorld((world) => world.run);
  const wish = {
    q: useDeferredValue(words.trim()),
    by: useDeferredValue(who.trim()),
    robot: robot === ALL ? '' : robot,
    effect: kind === 'any' ? '' : kind,
    before,
    language: i18n.language,
  };
  const found = useKept(useRequest(JSON.stringify([run, asked, wish]), () => getLog(wish)));
  const narrowed = wish.q !== '' || wish.by !== '' || wish.robot !== '' || wish.effect !== '';
  /** Another wish begins with the newest again. */
  const anew =
    <T,>(set: (value: T) => void) =>
    (value: T) => {
      set(value);
      setBefore(0);
    };
  return (
    <>
        <ChainMark asked={`${run} ${asked}`} />
        <div className={css.search} role="search">
          <TextField label={t('search')} value={words} onChange={anew(setWords)} maxLength={200} />
          <TextField label={t('who')} value={who} onChange={anew(setWho)} maxLength={200} />
          {names.length > 1 && (
            <Choice
              label={t('whose')}
              value={robot}
              options={[{ id: ALL, label: t('all') }, ...names.map((name) => ({ id: name, label: name }))]}
              onChange={anew(setRobot)}
            />
          )}
          <Choice
            label={t('kind')}
            value={kind}
            options={kinds.map((id) => ({ id, label: t(`kinds.${id}`) }))}
            onChange={anew(setKind)}
          />
        </div>
        <Lines found={found} narrowed={narrowed} onAgain={() => setAsked(asked + 1)} />
        <div className={css.foot}>
          <Button tone="quiet" onPress={() => setAsked(asked + 1)}>
            {t('again')}
          </Button>
          <Button icon="down" onPress={() => void attempt(async () => save(tableOf(await all(wish)), 'parley-log.csv'))}>
            {t('export')}
          </Button>
          {before > 0 && <Button onPress={() => setBefore(0)}>{t('newest')}</Button>}
          {found.state === 'ready' && !found.value.complete && (
            <Button onPress={() => setBefore(found.value.lines?.at(-1)?.number ?? 0)}>{t('older')}</Button>
          )}
        </div>
    </>
  );
}

const PAGE = 500;
const MOST = 10_000;

/** Everything that fits, the newest `MOST`, newest first. */
async function all(wish: LogWish): Promise<LogLine[]> {
  const lines: LogLine[] = [];
  for (let complete = false; !complete && lines.length < MOST; ) {
    const found = await getLog({ ...wish, before: lines.at(-1)?.number ?? 0, limit: PAGE });
    lines.push(...(found.lines ?? []));
    complete = (found.complete ?? true) || (found.lines ?? []).length === 0;
  }
  return lines;
}

interface LinesProps {
  found: Loaded<Found>;
  narrowed: boolean;
  onAgain: () => void;
}

function Lines({ found, narrowed, onAgain }: LinesProps) {
  const { t } = useTranslation(['log', 'common']);
  if (found.state === 'loading') return <Loading />;
  if (found.state === 'failed') {
    return (
      <Empty title={t('failed')}>
        <p role="alert">{found.reason}</p>
        <Button onPress={onAgain}>{t('common:tryAgain')}</Button>
      </Empty>
    );
  }
  const lines = found.value.lines ?? [];
  if (lines.length === 0) return <Empty title={narrowed ? t('none') : t('empty')}>{!narrowed && <p>{t('emptyText')}</p>}</Empty>;
  return (
    <>
      {found.value.problem && <p role="alert">{t('behind')}</p>}
      <ol className={css.list}>
        {lines.map((line) => (
          <Line key={line.number} line={line} />
        ))}
      </ol>
    </>
  );
}

function Line({ line }: { line: LogLine }) {
  const { t, i18n } = useTranslation('log');
  const now = useNow(MINUTE_MS);
  return (
    <li className={css.line} data-outcome={line.outcome} data-effect={line.effect}>
      <time dateTime={new Date(line.unix_ms).toISOString()} title={t('entry', { number: line.number })}>
        {timeOrDay(line.unix_ms, now, i18n.language)}
      </time>
      <span>{line.text}</span>
      {line.words && line.robot && (
        <Button needs="speak" tone="quiet" icon="undo" iconOnly aria-label={t('doAgain', { words: line.words })} onPress={() => sayAgain(line.robot ?? '', line.words ?? '')} />
      )}
    </li>
  );
}
