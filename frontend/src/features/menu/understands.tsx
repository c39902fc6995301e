import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { getModels } from '@/live/api';
import { useWorld } from '@/live/store';
import { useMay } from '@/state/me';
import { usePrefs } from '@/state/prefs';
import { Button } from '@/ui/button';
import { useRequest } from '@/ui/use-request';

import css from './menu.module.css';
import { pathOf } from './pages';

/** In one line what understands people here; more is told among the settings. */
export function Understands() {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  if (!info) return null;
  return (
    <Link className={css.note ?? ''} href={pathOf('settings')}>
      {t('understandsWith', { language: info.offline_language ? t('builtIn') : info.language })}
    </Link>
  );
}

/** Offers a model that is on this machine, or whose key is; it is used only when somebody starts Parley so. */
export function ModelNote() {
  const { t } = useTranslation('menu');
  const offline = useWorld((world) => world.info?.offline_language ?? false);
  const may = useMay('setting');
  const { modelNoted, set } = usePrefs();
  const found = useRequest(offline && may && !modelNoted ? 'models' : '', getModels);
  const [offer] = found.state === 'ready' && Array.isArray(found.value) ? found.value : [];
  if (!offer || modelNoted) return null;
  const option = `--language ${offer.language || 'auto:PROVIDER:MODEL'}`;
  return (
    <div className={css.offer}>
      <p>
        {offer.language ? t('modelFound', { model: offer.language.split(':').slice(2).join(':'), found: offer.found }) : t('keyFound', offer)} <code>{option}</code>
      </p>
      <Button onPress={() => void navigator.clipboard.writeText(option)}>{t('copy')}</Button>
      <Button onPress={() => set({ modelNoted: true })}>{t('notNow')}</Button>
    </div>
  );
}
