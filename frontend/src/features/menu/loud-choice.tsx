import { useTranslation } from 'react-i18next';

import { usePrefs } from '@/state/prefs';
import { Button } from '@/ui/button';

import { CallChoice } from './call-choice';
import css from './settings-page.module.css';

/** Whether robots that wait are heard; the browser is asked only when somebody wants that. */
export function LoudChoice() {
  const { t } = useTranslation('menu');
  const { loud, set } = usePrefs();
  const turn = () => {
    set({ loud: !loud });
    if (!loud && 'Notification' in window && Notification.permission === 'default') void Notification.requestPermission();
  };
  return (
    <section className={css.devices}>
      <h3>{t('loud')}</h3>
      <p>{loud ? t('loudOn') : t('loudText')}</p>
      <Button aria-pressed={loud} onPress={turn}>
        {loud ? t('loudEnd') : t('loudBegin')}
      </Button>
      <CallChoice />
    </section>
  );
}
