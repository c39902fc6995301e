import { useMemo } from 'react';
import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { linesOf } from '@/live/lines';
import { onServerClock } from '@/live/server-time';
import { useWorld } from '@/live/store';
import type { PlanView, StepView } from '@/live/types';
import { useAsked } from '@/state/asked';
import { useMood } from '@/state/mood';
import { Dot } from '@/ui/dot';
import { useNow } from '@/ui/use-now';
import { sentence, span } from '@/ui/words';

import css from './robot-line.module.css';

const AT_WORK: ReadonlySet<StepView['state']> = new Set(['running', 'waiting', 'paused', 'stopping']);
const OVER: ReadonlySet<PlanView['state']> = new Set(['idle', 'ended']);
const SECOND_MS = 1000;

/** How a robot fares: where it is, what it really does now, and for how long. */
export function RobotLine({ name, named }: { name: string; named: boolean }) {
  const { t } = useTranslation(['chat', 'robots']);
  const mood = useMood(name);
  const plans = useWorld((world) => world.plans);
  const task = useMemo(
    () => Object.values(plans).flatMap((plan) => (plan.robot === name ? (taskOf(plan) ?? []) : []))[0],
    [plans, name],
  );
  const asks = useAsked().some((entry) => entry.targets.includes(name));
  const shown = mood === 'idle' && asks ? 'waiting' : mood;
  const here = mood !== 'away' && mood !== 'unknown'; // else the rest is old
  return (
    <div className={css.line} role="group" aria-label={t('fares', { name })}>
      <p>
        <Dot mood={shown} />
        {named && <strong>{name}</strong>}
        <span>{t(`robots:state.${shown}`)}</span>
        {here && <Facts name={name} />}
      </p>
      {task && here && (
        <p className={css.task}>
          <Link href="/plan">{t('stepOf', { ...task, step: sentence(task.step.label) })}</Link>
          {task.step.working_since_unix_ms > 0 && mood === 'running' && <Worked step={task.step} />}
        </p>
      )}
    </div>
  );
}

function Facts({ name }: { name: string }) {
  const { t } = useTranslation('robots');
  const room = useWorld((world) => world.views[name]?.room ?? '');
  const holds = useWorld((world) => world.views[name]?.holds ?? '');
  const battery = useWorld((world) => world.robots[name]?.battery ?? null);
  return (
    <>
      {room && <span className={css.room}>{sentence(room)}</span>}
      {holds && <span>{t('holds', { thing: holds })}</span>}
      {battery !== null && <span>{t('percent', { percent: Math.round(battery * 100) })}</span>}
    </>
  );
}

/** The step that really runs, at which it got stuck, or with which it goes on. */
function taskOf(plan: PlanView) {
  if (OVER.has(plan.state)) return null;
  const lines = linesOf(plan.steps);
  const busy = lines.findIndex(({ step }) => AT_WORK.has(step.state) || step.state === 'failed');
  const at = busy < 0 && plan.state === 'paused' ? lines.findIndex(({ step }) => step.state === 'queued') : busy;
  const step = lines[at]?.step;
  return step ? { step, number: at + 1, all: lines.length } : null;
}

/** For how long a step has worked, or will still work as soon as that can be told; while it stood still does not count. */
function Worked({ step }: { step: StepView }) {
  const { t } = useTranslation('chat');
  const now = useNow(SECOND_MS);
  const leftMs = step.ends_unix_ms - onServerClock(now);
  const isTelling = leftMs > 0;
  const time = span(isTelling ? Math.max(leftMs, SECOND_MS) : step.worked_ms + onServerClock(now) - step.working_since_unix_ms);
  return <time aria-label={t(isTelling ? 'toGoLong' : 'since', { time })}>{isTelling ? t('toGo', { time }) : time}</time>;
}
