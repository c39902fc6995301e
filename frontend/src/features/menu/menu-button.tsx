import { useState } from 'react';
import { Button as AriaButton, DialogTrigger, Popover } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useOverlays } from '@/state/overlays';
import { Icon } from '@/ui/icon';

import css from './menu.module.css';
import { NavLinks } from './nav-links';
import { Understands } from './understands';

/** Opens the list of all pages. */
export function MenuButton({ className, placement }: { className?: string | undefined; placement: 'bottom start' | 'top end' }) {
  const { t } = useTranslation('menu');
  const [open, setOpen] = useState(false);
  const overlay = useOverlays((state) => state.set);
  const actions = () => {
    setOpen(false);
    overlay('commands');
  };
  return (
    <DialogTrigger isOpen={open} onOpenChange={setOpen}>
      <AriaButton className={className ?? ''}>
        <Icon name="menu" />
        <span>{t('menu')}</span>
      </AriaButton>
      <Popover className={css.drop ?? ''} placement={placement} aria-label={t('menu')}>
        <div className={css.dropBody}>
          <NavLinks onGo={() => setOpen(false)} />
          <button type="button" className={css.link} onClick={actions}>
            <Icon name="search" />
            {t('commandsShort')}
          </button>
          <Understands />
        </div>
      </Popover>
    </DialogTrigger>
  );
}
