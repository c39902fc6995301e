import { useTranslation } from 'react-i18next';
import { Link, useLocation } from 'wouter';

import { useWorld } from '@/live/store';
import { useMayAll } from '@/state/me';
import { Icon } from '@/ui/icon';

import css from './menu.module.css';
import { offered, pathOf } from './pages';

/** Links to all pages. @param onGo Called when one was followed. */
export function NavLinks({ onGo }: { onGo?: () => void }) {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const may = useMayAll();
  const [location] = useLocation();
  return (
    <nav aria-label={t('pages')}>
      <ul className={css.links}>
        {offered(info, may).map((page) => (
          <li key={page}>
            <Link
              href={pathOf(page)}
              className={css.link ?? ''}
              aria-current={location === pathOf(page) ? 'page' : undefined}
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
