import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { useMe } from '@/state/me';
import { usePrefs } from '@/state/prefs';
import { Button } from '@/ui/button';

import css from './people.module.css';

/** Says once that nobody has to sign in here, and what that means. */
export function OpenNote() {
  const { t } = useTranslation(['people', 'common']);
  const open = useMe(({ session }) => session?.way === 'open');
  const { openNoted, set } = usePrefs();
  if (!open || openNoted) return null;
  return (
    <div className={css.note}>
      <p>
        {t('open')} <Link href="/people">{t('makeAccounts')}</Link>
      </p>
      <Button onPress={() => set({ openNoted: true })}>{t('understood')}</Button>
    </div>
  );
}

/** Says why so little can be done. */
export function RoleNote() {
  const { t } = useTranslation('people');
  const viewer = useMe(({ session }) => session?.role === 'viewer');
  return viewer ? <p className={css.note}>{t('viewerNote')}</p> : null;
}
