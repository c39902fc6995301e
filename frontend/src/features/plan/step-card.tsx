import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import type { StepState, StepView } from '@/live/types';
import { Icon, type IconName } from '@/ui/icon';
import { needsCare } from '@/ui/risk';
import { addsTo, inWords, quoted, sentence } from '@/ui/words';

import { Details } from './details';
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

interface Props {
  step: StepView;
  number: number;
  changed: boolean;
  /** Given if the step can still be taken out. */
  onRemove?: (() => void) | null;
}

/** One step: what, why, how far. Its state is told by colour, sign and word. */
export function StepCard({ step, number, changed, onRemove = null }: Props) {
  const { t } = useTranslation('plan');
  const [open, setOpen] = useState(false);
  return (
    <li className={css.card} data-state={step.state} data-changed={changed || undefined}>
      <span className={css.mark} aria-hidden="true">
        <Icon name={icons[step.state]} size={18} />
      </span>
      <div className={css.body}>
        <div className={css.top}>
          <p className={css.label}>
            <span className={css.number}>{number}.</span> {sentence(step.label) || inWords(step.action)}
          </p>
          {onRemove && <Remove label={sentence(step.label)} onRemove={onRemove} />}
        </div>
        <div className={css.row}>
          <p className={css.state}>
            <span>{t(`step.${step.state}`)}</span>
            {changed && <span className={css.badge}>{t('changed')}</span>}
            {needsCare(step.risk) && <span className={css.badge}>{t('risky')}</span>}
            <Took step={step} />
          </p>
          <button type="button" className={css.more} aria-expanded={open} onClick={() => setOpen(!open)}>
            {open ? t('hideDetails') : t('showDetails')}
            <Icon name={open ? 'up' : 'down'} size={16} />
          </button>
        </div>
        {step.state === 'running' && <Progress step={step} />}
        <Told step={step} />
        {open && <Details step={step} />}
      </div>
    </li>
  );
}

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
  const name = t('removeStep', { step: label });
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
  if (step.started_unix_ms === 0 || step.ended_unix_ms <= step.started_unix_ms) return null;
  const seconds = Math.max(1, Math.round((step.ended_unix_ms - step.started_unix_ms) / 1000));
  const time =
    seconds < 60
      ? t('seconds', { count: seconds })
      : t('minutes', { minutes: Math.floor(seconds / 60), seconds: seconds % 60 });
  return <span>{t('took', { time })}</span>;
}
