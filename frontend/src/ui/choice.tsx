import { Button, Label, ListBox, ListBoxItem, Popover, Select, SelectValue } from 'react-aria-components';

import css from './choice.module.css';
import { Icon } from './icon';

export interface Option<T extends string> {
  id: T;
  label: string;
}

interface Props<T extends string> {
  label: string;
  /** The label is read out but not seen. */
  hideLabel?: boolean;
  value: T | null;
  options: readonly Option<T>[];
  placeholder?: string;
  isDisabled?: boolean;
  onChange: (value: T) => void;
}

/** One out of a list that drops down. */
export function Choice<T extends string>({ label, hideLabel, value, options, placeholder, isDisabled, onChange }: Props<T>) {
  return (
    <Select
      className={css.choice ?? ''}
      value={value}
      isDisabled={isDisabled ?? false}
      placeholder={placeholder ?? ''}
      onChange={(key) => {
        const option = options.find((other) => other.id === key);
        if (option) onChange(option.id);
      }}
    >
      <Label className={hideLabel ? 'hidden' : (css.label ?? '')}>{label}</Label>
      <Button className={css.button ?? ''}>
        <SelectValue className={css.value ?? ''} />
        <Icon name="down" size={18} />
      </Button>
      <Popover className={css.popover ?? ''}>
        <ListBox items={options} className={css.list ?? ''}>
          {(option) => (
            <ListBoxItem id={option.id} textValue={option.label} className={css.item ?? ''}>
              {option.label}
            </ListBoxItem>
          )}
        </ListBox>
      </Popover>
    </Select>
  );
}
