import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { getHistory, roundFile } from '@/live/api';
import { useWorld } from '@/live/store';
import type { RoundView } from '@/live/types';
import { useKeeping } from '@/state/favourites';
import { useOverlays } from '@/state/overlays';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Icon, type IconName } from '@/ui/icon';
import { Empty } from '@/ui/panel';
import { useNow } from '@/ui/use-now';
import { useKept, useRequest } from '@/ui/use-request';
import { clockTime, sentence, span, timeOrDay } from '@/ui/words';

import { sayAgain } from './again';
import css from './log.module.css';
import { NarrowBy, Paging, Shown, useNarrowing } from './narrowing';

const MINUTE_MS = 60_000;
const WEEK_DAYS = 6;
const days = ['today', 'week', 'any'] as const;

/** Midnight of that many days ago. */
function midnight(daysAgo: number): number {
  const day = new Date();
  day.setHours(0, 0, 0, 0);
  return day.setDate(day.getDate() - daysAgo);
}

/** What robots were told to do, how it ended and what they saw. */
export function Rounds() {
  const { t, i18n } = useTranslation('log');
  const by = useNarrowing();
  const [day, setDay] = useState<(typeof days)[number]>('today');
  const [asked, setAsked] = useState(0);
  const run = useWorld((world) => world.run);
  const plans = useWorld((world) => Object.values(world.plans).map((plan) => `${plan.graph_name} ${plan.state}`).join());
  const since = { today: midnight(0), week: midnight(WEEK_DAYS), any: 0 }[day];
  const wish = { ...by.wish, since, language: i18n.language };
  const found = useKept(useRequest(JSON.stringify([run, plans, asked, wish]), () => getHistory(wish)));
  return (
    <>
      <NarrowBy by={by} label={t('searchRounds')}>
        <Choice label={t('day')} value={day} options={days.map((id) => ({ id, label: t(`days.${id}`) }))} onChange={by.anew(setDay)} />
      </NarrowBy>
      <Shown found={found} onAgain={() => setAsked(asked + 1)}>
        {(page) => <List rounds={page.rounds ?? []} narrowed={by.narrowed} days={t(`days.${day}`)} all={day === 'any'} />}
      </Shown>
      <div className={css.foot}>
        {found.state === 'ready' && <Paging by={by} complete={found.value.complete ?? true} last={found.value.rounds?.at(-1)?.number} />}
      </div>
    </>
  );
}

function List({ rounds, narrowed, days, all }: { rounds: readonly RoundView[]; narrowed: boolean; days: string; all: boolean }) {
  const { t } = useTranslation('log');
  if (rounds.length === 0 && !narrowed && !all) return <Empty title={t('roundsNone', { days })}>{t('roundsNoneText')}</Empty>;
  if (rounds.length === 0) return <Empty title={narrowed ? t('none') : t('roundsEmpty')}>{!narrowed && <p>{t('roundsEmptyText')}</p>}</Empty>;
  return (
    <ol className={css.rounds}>
      {rounds.map((round) => (
        <Round key={round.number} round={round} />
      ))}
    </ol>
  );
}

const icons: Record<RoundView['state'], IconName> = { running: 'play', done: 'check', partly: 'skip', failed: 'bang', ended: 'cross', unrecorded: 'question' };

function Round({ round }: { round: RoundView }) {
  const { t, i18n } = useTranslation('log');
  const now = useNow(MINUTE_MS);
  const steps = round.steps ?? [];
  const title = titleOf(round);
  const { by, words, approved_by: yes, worked_ms: worked } = round;
  return (
    <li className={css.round} data-state={round.state}>
      <p className={css.roundHead}>
        <time dateTime={new Date(round.unix_ms).toISOString()}>{timeOrDay(round.unix_ms, now, i18n.language)}</time>
        <span className={css.roundState}>
          <Icon name={icons[round.state]} size={16} /> {t(`state.${round.state}`)}
        </span>
        {typeof worked === 'number' && <span>{t('worked', { time: span(worked) })}</span>}
        <span>{by ? t('by', { who: by, robot: round.robot }) : round.robot}</span>
      </p>
      <h3>{title}</h3>
      <Outcome round={round} />
      {yes && <p>{t('yes', { who: yes })}</p>}
      {steps.length > 0 && (
        <details>
          <summary>{t('stepsOf', { count: steps.length })}</summary>
          <ol className={css.steps}>
            {steps.map((step, index) => (
              <li key={`${index} ${step}`}>{sentence(step)}</li>
            ))}
          </ol>
        </details>
      )}
      <Findings round={round} title={title} />
      <div className={css.deeds}>
        {words && (
          <Button needs="speak" icon="again" aria-label={t('doAgain', { words })} onPress={() => sayAgain(round.robot, words)}>
            {t('againShort')}
          </Button>
        )}
        {words && <KeepButton words={words} />}
        <a className={css.file} href={roundFile(round.number, i18n.language)} download aria-label={t('file', { words: title })}>
          <Icon name="save" /> {t('fileShort')}
        </a>
      </div>
    </li>
  );
}

function Outcome({ round }: { round: RoundView }) {
  const { t } = useTranslation('log');
  const { left = [], found = [] } = round;
  return (
    <>
      {found.map((what) => (
        <p key={what} className={css.found}>
          <Icon name="bang" size={16} /> {t('found', { what })}
        </p>
      ))}
      {round.reason && <p>{round.reason}</p>}
      {left.length > 0 && <p>{t('left', { what: left.join('; ') })}</p>}
    </>
  );
}

function KeepButton({ words }: { words: string }) {
  const { t } = useTranslation('favourites');
  const open = useOverlays((state) => state.set);
  const keep = useKeeping((state) => state.keep);
  const show = () => {
    keep(words);
    open('favourites');
  };
  return (
    <Button needs="speak" icon="star" aria-label={t('keepRound', { words })} onPress={show}>
      {t('keepShort')}
    </Button>
  );
}

function Findings({ round, title }: { round: RoundView; title: string }) {
  const { t } = useTranslation('log');
  const pictures = round.pictures ?? [];
  if (pictures.length === 0) return null;
  return (
    <p className={css.pictures}>
      {pictures.map((address, index) => (
        <a key={address} href={address} target="_blank" rel="noreferrer">
          <img src={address} alt={t('picture', { number: index + 1, words: title })} loading="lazy" width={160} height={120} />
        </a>
      ))}
    </p>
  );
}

/** What was said, or where nothing was, what was done. */
export const titleOf = (round: RoundView) => sentence(round.words ?? '') || sentence((round.steps ?? []).join(', ')) || round.robot;

/** One round in one line, for those who come after. */
export function RoundLine({ round }: { round: RoundView }) {
  const { t, i18n } = useTranslation('log');
  const { by, left = [], found = [] } = round;
  return (
    <li>
      <time>{clockTime(round.unix_ms, i18n.language)}</time> {by ? t('by', { who: by, robot: round.robot }) : round.robot}: {titleOf(round)}
      {round.state !== 'running' && round.state !== 'done' && <> – {t(`state.${round.state}`)}</>}
      {found.length > 0 && <> – <strong>{t('found', { what: found.join(' ') })}</strong></>}
      {round.reason && <> – {round.reason}</>}
      {left.length > 0 && <> – {t('left', { what: left.join('; ') })}</>}
    </li>
  );
}
