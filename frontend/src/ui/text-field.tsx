import { Input, Label, Text, TextArea, TextField as AriaTextField, type TextFieldProps } from 'react-aria-components';

import css from './text-field.module.css';

interface Props extends Omit<TextFieldProps, 'children' | 'className'> {
  label: string;
  hideLabel?: boolean;
  help?: string;
  placeholder?: string;
  list?: string;
  /** So many lines to write in, rather than one. */
  rows?: number;
}

/** One line to write in, or several. */
export function TextField({ label, hideLabel, help, placeholder, list, rows, ...rest }: Props) {
  return (
    <AriaTextField {...rest} className={css.field ?? ''}>
      <Label className={hideLabel ? 'hidden' : (css.label ?? '')}>{label}</Label>
      {rows ? (
        <TextArea className={css.input ?? ''} placeholder={placeholder ?? ''} rows={rows} />
      ) : (
        <Input className={css.input ?? ''} placeholder={placeholder ?? ''} list={list} />
      )}
      {help && (
        <Text slot="description" className={css.help ?? ''}>
          {help}
        </Text>
      )}
    </AriaTextField>
  );
}
