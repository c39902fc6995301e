import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getHandover } from '@/live/api';
import type { Handover, RoundView } from '@/live/types';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { useRequest } from '@/ui/use-request';
import { clockTime, dayAndTime } from '@/ui/words';

import css from './log.module.css';
import { Shown } from './narrowing';
import { RoundLine } from './rounds';

const HOUR_MS = 3_600_000;
const states = { failed: ['failed', 'ended', 'unrecorded'], running: ['running'], done: ['done', 'partly'] } as const;
const hours = ['8', '12', '24'] as const;

/** What the next shift has to know, to read or to print. */
export function HandoverPart() {
  const { t, i18n } = useTranslation('log');
  const [of, setOf] = useState<(typeof hours)[number]>('8');
  const [asked, setAsked] = useState(() => Date.now());
  const wish = { since: asked - Number(of) * HOUR_MS, language: i18n.language };
  const found = useRequest(JSON.stringify(wish), () => getHandover(wish));
  return (
    <>
      <div className={css.search}>
        <Choice
          label={t('hours')}
          value={of}
          options={hours.map((id) => ({ id, label: t('hoursOf', { count: Number(id) }) }))}
          onChange={setOf}
        />
        <Button onPress={() => setAsked(Date.now())}>{t('again')}</Button>
        <Button icon="print" isDisabled={found.state !== 'ready'} onPress={() => window.print()}>
          {t('print')}
        </Button>
      </div>
      <Shown found={found} onAgain={() => setAsked(Date.now())}>
        {(told) => <Sheet told={told} />}
      </Shown>
    </>
  );
}

function Sheet({ told }: { told: Handover }) {
  const { t, i18n } = useTranslation('log');
  const at = (unixMs: number) => dayAndTime(unixMs, told.until_unix_ms, i18n.language);
  const rounds = told.rounds ?? [];
  const of = (states: readonly RoundView['state'][]) =>
    rounds.filter((round) => states.includes(round.state)).map((round) => <RoundLine key={round.number} round={round} />);
  const lines = (all: Handover['stops']) =>
    (all ?? []).map(([unixMs, text], index) => (
      <li key={`${index} ${unixMs}`}>
        <time>{clockTime(unixMs, i18n.language)}</time> {text}
      </li>
    ));
  return (
    <article className={css.sheet}>
      <h3>{t('handoverOf', { from: at(told.since_unix_ms), to: at(told.until_unix_ms) })}</h3>
      <Part title={t('waits')}>{(told.waits ?? []).map((text) => <li key={text}>{text}</li>)}</Part>
      <Part title={t('failedRounds')}>{of(states.failed)}</Part>
      <Part title={t('goesOn')}>{of(states.running)}</Part>
      <Part title={t('doneRounds')}>{of(states.done)}</Part>
      <Part title={t('stops')}>{lines(told.stops)}</Part>
      <Part title={t('rules')}>{lines(told.rules)}</Part>
      {!told.complete && <p>{t('more')}</p>}
      <p className={css.small}>{t('writtenBy')}</p>
    </article>
  );
}

function Part({ title, children }: { title: string; children: readonly React.ReactNode[] }) {
  const { t } = useTranslation('log');
  return (
    <section>
      <h4>{title}</h4>
      {children.length > 0 ? <ul>{children}</ul> : <p className={css.small}>{t('nothing')}</p>}
    </section>
  );
}
