import { useTranslation } from 'react-i18next';

import { useLive } from '@/live/store';

import css from './menu.module.css';
import { NavLinks } from './nav-links';
import { Understands } from './understands';

/** The menu where there is room for it. */
export function Sidebar() {
  return (
    <aside className={css.sidebar}>
      <Brand />
      <NavLinks />
      <div className={css.foot}>
        <Understands />
        <ConnectionNote />
      </div>
    </aside>
  );
}

export function Brand() {
  return (
    <h1 className={css.brand} translate="no">
      <img src="/icon.svg" alt="" width={28} height={28} />
      {/* eslint-disable-next-line i18next/no-literal-string -- the name is the same in every language */}
      <span>Parley</span>
    </h1>
  );
}

function ConnectionNote() {
  const { t } = useTranslation('menu');
  const connected = useLive((live) => live.connection === 'connected');
  return (
    <p className={css.connection} data-connected={connected}>
      <span aria-hidden="true" />
      {connected ? t('connected') : t('connecting')}
    </p>
  );
}
