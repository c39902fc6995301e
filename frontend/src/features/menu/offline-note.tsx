import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';

import css from './menu.module.css';

/** Says plainly when only the built-in understanding of language is there. */
export function OfflineNote() {
  const { t } = useTranslation('menu');
  const offline = useWorld((world) => world.info?.offline_language ?? false);
  if (!offline) return null;
  return <p className={css.note}>{t('offlineLanguage')}</p>;
}
