import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { OVER } from '@/live/lines';
import { useWorld } from '@/live/store';
import type { StepState, StepView } from '@/live/types';
import { Icon, type IconName } from '@/ui/icon';
import { needsCare } from '@/ui/risk';
import { addsTo, inWords, quoted, sentence } from '@/ui/words';

import { Details } from './details';
import type { Line } from '@/live/lines';
import css from './step-card.module.css';

const icons: Record<StepState, IconName> = {
  queued: 'dots',
  running: 'play',
  finished: 'check',
  failed: 'bang',
  stopped: 'square',
  skipped: 'skip',
  paused: 'pause',
  stopping: 'square',
  waiting: 'question',
};

/** States that the sign alone says well enough to those who see it. */
const PLAIN: ReadonlySet<StepState> = new Set(['queued', 'finished']);

interface Props {
  line: Line;
  number: number;
  changed: boolean;
  /** Whether its plan waits for help with what did not work. */
  isHeld?: boolean;
  /** Given if the step can still be taken out. */
  onRemove?: (() => void) | null;
}

/** One step on one line: sign, what it does, how long it took; the rest on a tap. Never told by colour alone. */
export function StepCard({ line, number, changed, isHeld = false, onRemove = null }: Props) {
  const { t } = useTranslation('plan');
  const [open, setOpen] = useState(false);
  const { step } = line;
  const label = sentence(step.label) || inWords(step.action);
  const state = useShownState(step, isHeld);
  return (
    <li className={css.card} data-comes data-state={step.state} data-changed={changed || undefined}>
      <div className={css.line}>
        <button type="button" className={css.head} aria-expanded={open} onClick={() => setOpen(!open)}>
          <span className={css.mark} aria-hidden="true">
            <Icon name={icons[step.state]} size={16} />
          </span>
          <span className={css.words}>
            <span className={css.label}>
              <span className={css.number}>{number}.</span> {label}
            </span>{' '}
            <span className={PLAIN.has(step.state) ? 'hidden' : css.state}>{t(`step.${state}`)}</span>{' '}
            {changed && <span className={css.badge}>{t('changed')}</span>}{' '}
            {needsCare(step.risk) && <span className={css.badge}>{t('risky')}</span>}
          </span>
          <Took step={step} />
          <Icon name={open ? 'up' : 'down'} size={16} />
        </button>
        {onRemove && <Remove label={label} onRemove={onRemove} />}
      </div>
      {step.state === 'running' && <Progress step={step} />}
      <Told step={step} />
      {open && <Details line={line} />}
    </li>
  );
}

function useShownState(step: StepView, isHeld: boolean) {
  if (useFound(step)) return 'found';
  return isHeld && step.state === 'failed' ? 'held' : step.state;
}

/** Whether a step counts as failed only because of what it found: looking itself went well. */
const useFound = (step: StepView) =>
  useWorld(
    ({ incidents }) =>
      step.state === 'failed' &&
      step.message !== '' &&
      Object.values(incidents).some(({ code, message }) => code === 'attention' && message === step.message),
  );

/** Why it failed, and what whoever planned it says about it: its words, never ours. */
function Told({ step }: { step: StepView }) {
  const { t } = useTranslation('plan');
  return (
    <>
      {step.message && <p className={css.message}>{step.message}</p>}
      {addsTo(step.label, step.reason) && <p className={css.reason}>{t('says', { words: quoted(step.reason) })}</p>}
    </>
  );
}

function Remove({ label, onRemove }: { label: string; onRemove: () => void }) {
  const { t } = useTranslation('plan');
  const name = t('removeStep', { step: quoted(label) });
  return (
    <button type="button" className={css.remove} aria-label={name} title={name} onClick={onRemove}>
      <Icon name="trash" size={16} />
    </button>
  );
}

function Progress({ step }: { step: StepView }) {
  const { t } = useTranslation('plan');
  const percent = step.progress === null || step.progress === undefined ? null : Math.round(step.progress * 100);
  return (
    <div className={css.progress}>
      <div
        className={css.bar}
        role="progressbar"
        aria-label={step.label || t('step.running')}
        aria-valuemin={0}
        aria-valuemax={100}
        {...(percent === null ? {} : { 'aria-valuenow': percent })}
      >
        <div className={percent === null ? css.unknown : css.filled} style={percent === null ? {} : { width: `${percent}%` }} />
      </div>
      {step.progress_text && <span>{step.progress_text}</span>}
    </div>
  );
}

function Took({ step }: { step: StepView }) {
  const { t } = useTranslation('plan');
  if (step.worked_ms <= 0 || !OVER.has(step.state)) return null;
  const seconds = Math.max(1, Math.round(step.worked_ms / 1000));
  const time =
    seconds < 60
      ? t('seconds', { count: seconds })
      : t('minutes', { minutes: Math.floor(seconds / 60), seconds: seconds % 60 });
  return (
    <span className={css.took}>
      <span className="hidden">{t('took')} </span>
      {time}
    </span>
  );
}
