import { Input, Label, Text, TextField as AriaTextField, type TextFieldProps } from 'react-aria-components';

import css from './text-field.module.css';

interface Props extends Omit<TextFieldProps, 'children' | 'className'> {
  label: string;
  hideLabel?: boolean;
  help?: string;
  placeholder?: string;
  list?: string;
}

/** One line to write in. */
export function TextField({ label, hideLabel, help, placeholder, list, ...rest }: Props) {
  return (
    <AriaTextField {...rest} className={css.field ?? ''}>
      <Label className={hideLabel ? 'hidden' : (css.label ?? '')}>{label}</Label>
      <Input className={css.input ?? ''} placeholder={placeholder ?? ''} list={list} />
      {help && (
        <Text slot="description" className={css.help ?? ''}>
          {help}
        </Text>
      )}
    </AriaTextField>
  );
}
