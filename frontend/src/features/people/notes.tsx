import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { useLive, useWorld } from '@/live/store';
import { useAsked } from '@/state/asked';
import { useMe } from '@/state/me';
import { usePrefs } from '@/state/prefs';
import { Button } from '@/ui/button';
import { useLayout } from '@/ui/use-media';

import css from './people.module.css';

/** Says once that nobody has to sign in here, and what that means. */
export function OpenNote() {
  const { t } = useTranslation(['people', 'common']);
  const open = useMe(({ session }) => session?.way === 'open');
  const { openNoted, set } = usePrefs();
  const isUrgent = useIsUrgent();
  const isSmall = useLayout() === 'phone';
  if (!open || openNoted || (isSmall && isUrgent)) return null;
  return (
    <div className={css.note}>
      <p>
        {t('open')} <Link href="/people">{t('makeAccounts')}</Link>
      </p>
      <Button onPress={() => set({ openNoted: true })}>{t('understood')}</Button>
    </div>
  );
}

/** Whether what robots wait for needs the room of a small screen. */
function useIsUrgent(): boolean {
  const asks = useAsked().length > 0;
  const proposes = useWorld((world) => Object.keys(world.proposals).length > 0);
  const stands = useWorld((world) => Object.values(world.robots).some((robot) => robot.state === 'stopped'));
  const isLost = useLive((live) => live.connection === 'lost');
  return asks || proposes || stands || isLost;
}

/** Says why so little can be done. */
export function RoleNote() {
  const { t } = useTranslation('people');
  const viewer = useMe(({ session }) => session?.role === 'viewer');
  return viewer ? <p className={css.note}>{t('viewerNote')}</p> : null;
}
