import { useTranslation } from 'react-i18next';
import { Link, useLocation } from 'wouter';

import { useWorld } from '@/live/store';
import { useMayAll } from '@/state/me';
import { Icon } from '@/ui/icon';

import css from './menu.module.css';
import { offered, pathOf } from './pages';

/** Arrow keys lead from one link to the next, so that all of them are one stop on the way to the page. */
function onKeyDown(event: React.KeyboardEvent<HTMLElement>) {
  const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!by) return;
  event.preventDefault();
  const links = [...event.currentTarget.querySelectorAll('a')];
  links[links.findIndex((link) => link === document.activeElement) + by]?.focus();
}

/** Links to all pages. @param onGo Called when one was followed. */
export function NavLinks({ onGo }: { onGo?: () => void }) {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const may = useMayAll();
  const [location] = useLocation();
  const pages = offered(info, may);
  const here = pages.find((page) => location === pathOf(page)) ?? pages[0];
  return (
    <nav aria-label={t('pages')}>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- keys move between its links */}
      <ul className={css.links} onKeyDown={onKeyDown}>
        {pages.map((page) => (
          <li key={page}>
            <Link
              href={pathOf(page)}
              className={css.link ?? ''}
              aria-current={location === pathOf(page) ? 'page' : undefined}
              tabIndex={page === here ? 0 : -1}
              onClick={() => onGo?.()}
            >
              <Icon name={page} />
              <span>{t(page)}</span>
            </Link>
          </li>
        ))}
      </ul>
    </nav>
  );
}
