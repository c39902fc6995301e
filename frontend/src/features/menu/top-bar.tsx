import { useState } from 'react';
import { Button as AriaButton, Dialog, DialogTrigger, Popover } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { Icon } from '@/ui/icon';

import css from './menu.module.css';
import { NavLinks } from './nav-links';
import { Understands } from './understands';
import { Brand } from './sidebar';

/** The menu as a banner with a list that drops down. */
export function TopBar({ children }: { children: React.ReactNode }) {
  const { t } = useTranslation('menu');
  const [open, setOpen] = useState(false);
  return (
    <header className={css.topBar}>
      <DialogTrigger isOpen={open} onOpenChange={setOpen}>
        <AriaButton className={css.menuButton ?? ''}>
          <Icon name="menu" />
          <span>{t('menu')}</span>
        </AriaButton>
        <Popover className={css.drop ?? ''} placement="bottom start">
          <Dialog aria-label={t('menu')} className={css.dropBody ?? ''}>
            <NavLinks onGo={() => setOpen(false)} />
            <Understands />
          </Dialog>
        </Popover>
      </DialogTrigger>
      <Brand />
      <div className={css.right}>{children}</div>
    </header>
  );
}
