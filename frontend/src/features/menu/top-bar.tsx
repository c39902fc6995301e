import css from './menu.module.css';
import { MenuButton } from './menu-button';
import { Brand } from './sidebar';

/** The menu as a banner with a list that drops down; where a thumb does not reach up to it, it stands below. */
export function TopBar({ hasMenu, children }: { hasMenu: boolean; children: React.ReactNode }) {
  return (
    <header className={css.topBar} data-menu={hasMenu}>
      {hasMenu && <MenuButton className={css.menuButton} placement="bottom start" />}
      <Brand />
      <div className={css.right}>{children}</div>
    </header>
  );
}
