import { Button as AriaButton, Checkbox, GridListItem } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import type { ParameterView } from '@/live/types';
import { Button } from '@/ui/button';
import { Icon } from '@/ui/icon';
import { TextField } from '@/ui/text-field';
import { inWords, sentence } from '@/ui/words';

import { inputsOf, type DraftStep } from './editing';
import css from './plan-editor.module.css';

interface Props {
  step: DraftStep;
  isFirst: boolean;
  isLast: boolean;
  onMove: (by: -1 | 1) => void;
  onRemove: () => void;
  onChange: (name: string, value: string | number | boolean) => void;
}

/** One step that can be moved, changed and removed. */
export function EditorRow({ step, isFirst, isLast, onMove, onRemove, onChange }: Props) {
  const { t } = useTranslation('plan');
  const inputs = inputsOf(step);
  return (
    <GridListItem id={step.id} textValue={step.label} className={css.row ?? ''}>
      <div className={css.head}>
        <AriaButton slot="drag" className={css.grip ?? ''} aria-label={t('drag', { step: step.label })}>
          <Icon name="grip" />
        </AriaButton>
        <span className={css.label}>{sentence(step.label)}</span>
        <Button tone="quiet" icon="up" iconOnly isDisabled={isFirst} aria-label={t('moveUp', { step: step.label })} onPress={() => onMove(-1)} />
        <Button tone="quiet" icon="down" iconOnly isDisabled={isLast} aria-label={t('moveDown', { step: step.label })} onPress={() => onMove(1)} />
        <Button tone="quiet" icon="trash" iconOnly aria-label={t('removeStep', { step: step.label })} onPress={onRemove} />
      </div>
      {inputs.length > 0 && (
        <div className={css.inputs}>
          {inputs.map((input) => (
            <Input key={input.name} input={input} onChange={(value) => onChange(input.name, value)} />
          ))}
        </div>
      )}
    </GridListItem>
  );
}

function Input({ input, onChange }: { input: ParameterView; onChange: (value: string | number | boolean) => void }) {
  const label = inWords(input.name);
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
      value={input.value === null || input.value === undefined ? '' : String(input.value)}
      onChange={(text) => {
        if (!isNumber) onChange(text);
        else if (text !== '' && Number.isFinite(Number(text))) onChange(Number(text));
      }}
    />
  );
}
