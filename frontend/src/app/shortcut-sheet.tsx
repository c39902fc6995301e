import { useTranslation } from 'react-i18next';

import { useOverlays } from '@/state/overlays';
import { Dialog } from '@/ui/dialog';

import css from './overlays.module.css';

const rows = [
  { what: 'stop', keys: ['Esc Esc'] },
  { what: 'commands', keys: ['Ctrl K'] },
  { what: 'help', keys: ['?'] },
  { what: 'robot', keys: ['Alt 1', 'Alt 2'] },
  { what: 'write', keys: ['/'] },
  { what: 'search', keys: ['Ctrl F'] },
  { what: 'last', keys: ['↑'] },
] as const;

/** Which keys do what. */
export function ShortcutSheet() {
  const { t } = useTranslation('menu');
  const { open, set } = useOverlays();
  return (
    <Dialog title={t('shortcuts')} isOpen={open === 'shortcuts'} onClose={() => set('none')}>
      <dl className={css.keys}>
        {rows.map(({ what, keys }) => (
          <div key={what}>
            <dt>{t(`shortcut.${what}`)}</dt>
            <dd>
              {keys.map((key) => (
                <kbd key={key}>{key}</kbd>
              ))}
            </dd>
          </div>
        ))}
      </dl>
    </Dialog>
  );
}
