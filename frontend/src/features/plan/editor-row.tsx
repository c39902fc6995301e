import { memo } from 'react';
import { Button as AriaButton, Checkbox, GridListItem } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import type { AbilityView, ParameterInfo, ParameterView } from '@/live/types';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Icon } from '@/ui/icon';
import { TextField } from '@/ui/text-field';
import { quoted, sentence } from '@/ui/words';

import { inputsOf, type DraftStep } from './editing';
import { labelOf } from './parameters';
import { PlacePicker, type Places } from './place-picker';
import css from './plan-editor.module.css';

interface Props {
  step: DraftStep;
  catalogue: readonly AbilityView[];
  places: Places;
  isFirst: boolean;
  isLast: boolean;
  onMove: (step: DraftStep, by: -1 | 1) => void;
  onRemove: (step: DraftStep) => void;
  onChange: (step: DraftStep, name: string, value: string | number | boolean) => void;
}

/** One step that can be moved, changed and removed. */
export const EditorRow = memo(function EditorRow({ step, catalogue, places, isFirst, isLast, onMove, onRemove, onChange }: Props) {
  const { t } = useTranslation('plan');
  const inputs = inputsOf(step);
  const actions = [step, ...step.finding].map((one) => one.action);
  const known = catalogue.filter((one) => actions.includes(one.name));
  const about = (name: string) => known.map((one) => one.parameters?.[name]).find((one) => one !== undefined);
  return (
    <GridListItem id={step.id} textValue={step.label} className={css.row ?? ''}>
      <div className={css.head}>
        <AriaButton slot="drag" className={css.grip ?? ''} aria-label={t('drag', { step: quoted(step.label) })}>
          <Icon name="grip" />
        </AriaButton>
        <span className={css.label}>{sentence(step.label)}</span>
        <Button tone="quiet" icon="up" iconOnly isDisabled={isFirst} aria-label={t('moveUp', { step: quoted(step.label) })} onPress={() => onMove(step, -1)} />
        <Button tone="quiet" icon="down" iconOnly isDisabled={isLast} aria-label={t('moveDown', { step: quoted(step.label) })} onPress={() => onMove(step, 1)} />
        <Button tone="quiet" icon="trash" iconOnly aria-label={t('removeStep', { step: quoted(step.label) })} onPress={() => onRemove(step)} />
      </div>
      {inputs.length > 0 && (
        <div className={css.inputs}>
          {inputs.filter((input) => about(input.name)?.kind !== 'id').map((input) => (
            <Input key={input.name} input={input} about={about(input.name)} places={places} onChange={(value) => onChange(step, input.name, value)} />
          ))}
        </div>
      )}
    </GridListItem>
  );
});

interface InputProps {
  input: ParameterView;
  about: ParameterInfo | undefined;
  places: Places;
  onChange: (value: string | number | boolean) => void;
}

/** A field of the kind that the input is of; places and closed lists are chosen from. */
function Input({ input, about, places, onChange }: InputProps) {
  const { t } = useTranslation('plan');
  const label = named(input, about, t('place'));
  const value = String(input.value ?? '');
  if (about?.kind === 'place' && places.names.length > 0) {
    return (
      <div className={css.place}>
        <Listed label={label} value={value} listed={places.names} onChange={onChange} />
        <PlacePicker places={places} label={label} onPick={onChange} />
      </div>
    );
  }
  const listed = about?.choices ?? [];
  if (listed.length > 0) return <Listed label={label} value={value} listed={listed} onChange={onChange} />;
  if (input.type === 'bool') {
    return (
      <Checkbox className={css.check ?? ''} isSelected={input.value === true} onChange={onChange}>
        <span className={css.box}>{input.value === true && <Icon name="check" size={16} />}</span>
        {label}
      </Checkbox>
    );
  }
  const isNumber = input.type === 'number';
  return (
    <TextField
      label={label}
      type={isNumber ? 'number' : 'text'}
      value={value}
      onChange={(text) => {
        if (!isNumber) onChange(text);
        else if (text !== '' && Number.isFinite(Number(text))) onChange(Number(text));
      }}
    />
  );
}

interface ListedProps {
  label: string;
  value: string;
  listed: readonly string[];
  onChange: (value: string) => void;
}

/** One of a list; what is there already and not in it stays to be chosen. */
function Listed({ label, value, listed, onChange }: ListedProps) {
  const { t } = useTranslation('plan');
  const options = value && !listed.includes(value) ? [value, ...listed] : listed;
  const offered = options.map((one) => ({ id: one, label: sentence(one) }));
  return <Choice label={label} placeholder={t('choose')} value={value || null} options={offered} onChange={onChange} />;
}

function named(input: ParameterView, about: ParameterInfo | undefined, place: string): string {
  if (about?.kind === 'place') return place;
  const label = labelOf(input.name, about);
  return about?.unit ? `${label} (${about.unit})` : label;
}
