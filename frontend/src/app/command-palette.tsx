import { Autocomplete, Menu, MenuItem, useFilter } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useOverlays } from '@/state/overlays';
import { Dialog } from '@/ui/dialog';
import { TextField } from '@/ui/text-field';

import css from './overlays.module.css';
import { useCommands } from './use-commands';

/** Everything one can do, found by a few letters. */
export function CommandPalette() {
  const { t } = useTranslation('menu');
  const { open, set } = useOverlays();
  return (
    <Dialog title={t('commands')} isOpen={open === 'commands'} onClose={() => set('none')}>
      <Commands onDone={() => set('none')} />
    </Dialog>
  );
}

function Commands({ onDone }: { onDone: () => void }) {
  const { t } = useTranslation('menu');
  const { contains } = useFilter({ sensitivity: 'base' });
  const commands = useCommands();
  return (
    <Autocomplete filter={contains}>
      <TextField label={t('commandsPlaceholder')} autoFocus />
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys */}
      <div className={css.scroller} tabIndex={0} role="group" aria-label={t('commands')}>
        <Menu
          className={css.list ?? ''}
          aria-label={t('commands')}
          items={commands}
          renderEmptyState={() => <p>{t('commandsNone')}</p>}
          onAction={(id) => {
            onDone();
            commands.find((command) => command.id === id)?.run();
          }}
        >
          {(command) => (
            <MenuItem id={command.id} textValue={command.label} className={css.item ?? ''}>
              {command.label}
            </MenuItem>
          )}
        </Menu>
      </div>
    </Autocomplete>
  );
}
