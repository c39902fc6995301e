import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getLog, type LogWish } from '@/live/api';
import { useWorld } from '@/live/store';
import type { LogLine, LogPage } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Empty } from '@/ui/panel';
import { useNow } from '@/ui/use-now';
import { useKept, useRequest } from '@/ui/use-request';
import { timeOrDay } from '@/ui/words';

import { sayAgain } from './again';
import { ChainMark } from './chain-mark';
import { kinds, type Kind } from './kinds';
import css from './log.module.css';
import { NarrowBy, Paging, Shown, useNarrowing } from './narrowing';
import { save, tableOf } from './table';

const MINUTE_MS = 60_000;

/** Who did what: to look through, narrow down and trust. */
export function LogPart() {
  const { t, i18n } = useTranslation('log');
  const by = useNarrowing();
  const [kind, setKind] = useState<Kind>('any');
  const [asked, setAsked] = useState(0);
  const run = useWorld((world) => world.run);
  const wish = { ...by.wish, effect: kind === 'any' ? '' : kind, language: i18n.language };
  const found = useKept(useRequest(JSON.stringify([run, asked, wish]), () => getLog(wish)));
  const again = () => setAsked(asked + 1);
  return (
    <>
      <ChainMark asked={`${run} ${asked}`} />
      <NarrowBy by={by} label={t('search')}>
        <Choice
          label={t('kind')}
          value={kind}
          options={kinds.map((id) => ({ id, label: t(`kinds.${id}`) }))}
          onChange={by.anew(setKind)}
        />
      </NarrowBy>
      <Shown found={found} onAgain={again}>
        {(page) => <Lines page={page} narrowed={by.narrowed || wish.effect !== ''} />}
      </Shown>
      <div className={css.foot}>
        <Button tone="quiet" onPress={again}>
          {t('again')}
        </Button>
        <Button icon="save" onPress={() => void attempt(async () => save(tableOf(await all(wish)), 'parley-log.csv'))}>
          {t('export')}
        </Button>
        {found.state === 'ready' && <Paging by={by} complete={found.value.complete ?? true} last={found.value.lines?.at(-1)?.number} />}
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

function Lines({ page, narrowed }: { page: LogPage; narrowed: boolean }) {
  const { t } = useTranslation('log');
  const lines = page.lines ?? [];
  if (lines.length === 0) return <Empty title={narrowed ? t('none') : t('empty')}>{!narrowed && <p>{t('emptyText')}</p>}</Empty>;
  return (
    <>
      {page.problem && <p role="alert">{t('behind')}</p>}
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
        <Button needs="speak" tone="quiet" icon="again" iconOnly aria-label={t('doAgain', { words: line.words })} onPress={() => sayAgain(line.robot ?? '', line.words ?? '')} />
      )}
    </li>
  );
}
