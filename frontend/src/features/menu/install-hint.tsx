import { useTranslation } from 'react-i18next';

import { isInstalled, useInstall } from '@/state/install';
import { Button } from '@/ui/button';

import css from './settings-page.module.css';

/** How to keep the page on this device like an app. */
export function InstallHint() {
  const { t } = useTranslation('menu');
  const { offer, set } = useInstall();
  if (isInstalled()) return null;
  const install = () => {
    set(null); // an offer can be taken up once
    void offer?.prompt();
  };
  return (
    <section className={css.devices}>
      <h3>{t('install')}</h3>
      <p>{offer ? t('installText') : t('installByHand')}</p>
      {offer && <Button onPress={install}>{t('installNow')}</Button>}
    </section>
  );
}
