import { createContext, useContext } from 'react';
import { Button as AriaButton, type ButtonProps } from 'react-aria-components';

import { useMe, type Effect } from '@/state/me';

import css from './button.module.css';
import { Icon, type IconName } from './icon';

interface Props extends Omit<ButtonProps, 'children' | 'className'> {
  tone?: 'plain' | 'main' | 'danger' | 'quiet';
  icon?: IconName;
  children?: React.ReactNode;
  /** Only the sign is shown; `aria-label` says what it does. */
  iconOnly?: boolean;
  /** Whoever may not do this does not see the button. */
  needs?: Effect;
}

/** True in parts of the page beside the one in which people act: what stands out there would be one of two. */
export const Beside = createContext(false);

/** A button that is large enough for a thumb. */
export function Button({ needs, ...rest }: Props) {
  const session = useMe((me) => me.session);
  return needs && session && !session.may.includes(needs) ? null : <Shown {...rest} />;
}

function Shown({ tone = 'plain', icon, children, iconOnly = false, ...rest }: Omit<Props, 'needs'>) {
  const beside = useContext(Beside);
  return (
    <AriaButton {...rest} className={[css.button, css[tone === 'main' && beside ? 'plain' : tone], iconOnly ? css.iconOnly : ''].join(' ')}>
      {icon && <Icon name={icon} />}
      {!iconOnly && children && <span>{children}</span>}
    </AriaButton>
  );
}
