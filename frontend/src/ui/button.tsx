import { Button as AriaButton, type ButtonProps } from 'react-aria-components';

import css from './button.module.css';
import { Icon, type IconName } from './icon';

interface Props extends Omit<ButtonProps, 'children' | 'className'> {
  tone?: 'plain' | 'main' | 'danger' | 'quiet';
  icon?: IconName;
  children?: React.ReactNode;
  /** Only the sign is shown; `aria-label` says what it does. */
  iconOnly?: boolean;
}

/** A button that is large enough for a thumb. */
export function Button({ tone = 'plain', icon, children, iconOnly = false, ...rest }: Props) {
  return (
    <AriaButton {...rest} className={[css.button, css[tone], iconOnly ? css.iconOnly : ''].join(' ')}>
      {icon && <Icon name={icon} />}
      {!iconOnly && children && <span>{children}</span>}
    </AriaButton>
  );
}
