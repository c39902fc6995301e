import { useTranslation } from 'react-i18next';
import { Link, useLocation } from 'wouter';

import { useWorld } from '@/live/store';
import { Icon } from '@/ui/icon';

import css from './menu.module.css';
import { MenuButton } from './menu-button';
import { here, pathOf, type Page } from './pages';

const AT_HAND: readonly Page[] = ['chat', 'plan', 'map'];

/** Menu and the pages of everyday use, where a thumb reaches them. */
export function BottomBar() {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const [location] = useLocation();
  const pages = here(info).filter((page) => AT_HAND.includes(page));
  return (
    <nav className={css.bottomBar} aria-label={t('atHand')}>
      {pages.map((page) => (
        <Link key={page} href={pathOf(page)} className={css.tab ?? ''} aria-current={location === pathOf(page) ? 'page' : undefined}>
          <Icon name={page} />
          <span>{t(page)}</span>
        </Link>
      ))}
      <MenuButton className={css.tab} placement="top end" />
    </nav>
  );
}
