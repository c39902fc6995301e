import { Button as AriaButton, Menu, MenuItem, MenuTrigger, Popover } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useRobotNames } from '@/state/selection';
import { useStopping } from '@/state/stopping';

import { Icon } from './icon';
import css from './stop-button.module.css';

/** Stops every robot with one tap; its small neighbour stops one of several. */
export function StopButton() {
  const { t } = useTranslation('stop');
  const names = useRobotNames();
  const stop = useStopping((state) => state.stop);
  const several = names.length > 1;
  return (
    <div className={css.group} data-stops>
      <button type="button" className={css.stop} title={t('help')} onClick={() => void stop([])}>
        <Icon name="octagon" size={22} />
        <span>{several ? t('stopAll') : t('stop')}</span>
      </button>
      {several && (
        <MenuTrigger>
          <AriaButton className={css.more ?? ''} aria-label={t('more')}>
            <Icon name="down" />
          </AriaButton>
          <Popover className={css.popover ?? ''}>
            <Menu className={css.menu ?? ''} aria-label={t('more')} onAction={(name) => void stop([String(name)])}>
              {names.map((name) => (
                <MenuItem key={name} id={name} className={css.item ?? ''}>
                  {t('stopOnly', { name })}
                </MenuItem>
              ))}
            </Menu>
          </Popover>
        </MenuTrigger>
      )}
    </div>
  );
}
