import { useTranslation } from 'react-i18next';

import type { ParameterView, StepView } from '@/live/types';
import { inWords } from '@/ui/words';

import css from './details.module.css';
import { rowsOf, type Row } from './parameters';

/** What a step was given and what it found out. */
export function Details({ step }: { step: StepView }) {
  const { t } = useTranslation('plan');
  return (
    <div className={css.details}>
      <p className={css.action}>{inWords(step.action)}</p>
      <Values title={t('given')} parameters={step.inputs} />
      <Values title={t('found')} parameters={step.outputs} />
    </div>
  );
}

function Values({ title, parameters }: { title: string; parameters: readonly ParameterView[] }) {
  if (parameters.length === 0) return null;
  return (
    <>
      <p className={css.title}>{title}</p>
      <dl className={css.rows}>
        {rowsOf(parameters).map((row) => (
          <Value key={row.name} row={row} />
        ))}
      </dl>
    </>
  );
}

function Value({ row }: { row: Row }) {
  const { t } = useTranslation('plan');
  const value =
    row.kind === 'place'
      ? t('placeValue', { x: row.x.toFixed(2), y: row.y.toFixed(2), degrees: row.degrees ?? 0 })
      : (row.value ?? t('noValue'));
  return (
    <div>
      <dt>{row.label || t('place')}</dt>
      <dd>{value}</dd>
    </div>
  );
}
