import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { AbilityView, ParameterView, StepView } from '@/live/types';
import type { World } from '@/live/world';
import { clockTime, inWords } from '@/ui/words';

import css from './details.module.css';
import type { Line } from '@/live/lines';
import { rowsOf, type Row } from './parameters';

/** What a step was given, what it found out, and under what circumstances. */
export function Details({ line: { step, finding } }: { line: Line }) {
  const { t } = useTranslation('plan');
  const known = useWorld((world) => actionOf(world, step.action));
  return (
    <div className={css.details}>
      <p className={css.action}>{known?.description || inWords(step.action)}</p>
      <Values title={t('given')} parameters={step.inputs} about={known?.parameters} />
      <Values title={t('found')} parameters={[...finding.flatMap((one) => one.outputs), ...step.outputs]} />
      <Circumstances step={step} />
    </div>
  );
}

/** What robots say of an action. */
function actionOf(world: World, action: string): AbilityView | undefined {
  return Object.values(world.robots)
    .flatMap((robot) => robot.catalogue)
    .find((one) => one.name === action);
}

/** Under what circumstances it was done. */
function Circumstances({ step }: { step: StepView }) {
  const { t, i18n } = useTranslation('plan');
  const at = (unixMs: number) => clockTime(unixMs, i18n.language, true);
  return (
    <>
      <p className={css.title}>{t('circumstances')}</p>
      <dl className={css.rows}>
        <Fact name={t('care')} value={t(`cares.${step.risk}`)} />
        {step.started_unix_ms > 0 && <Fact name={t('began')} value={at(step.started_unix_ms)} />}
        {step.ended_unix_ms > 0 && <Fact name={t('ended')} value={at(step.ended_unix_ms)} />}
      </dl>
    </>
  );
}

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value}</dd>
    </div>
  );
}

interface ValuesProps {
  title: string;
  parameters: readonly ParameterView[];
  about?: AbilityView['parameters'] | undefined;
}

function Values({ title, parameters, about }: ValuesProps) {
  const rows = rowsOf(parameters, about);
  if (rows.length === 0) return null;
  const isOneResult = rows.length === 1 && !about; // what programs call it says no more than the heading
  return (
    <>
      {!isOneResult && <p className={css.title}>{title}</p>}
      <dl className={css.rows}>
        {rows.map((row) => (
          <Value key={row.name} row={isOneResult ? { ...row, label: title } : row} />
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
