import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import { Link, useRoute } from 'wouter';

import { getModels, putModel } from '@/live/api';
import { useWorld } from '@/live/store';
import type { ModelOffer } from '@/live/types';
import { attempt } from '@/state/do';
import { useMay } from '@/state/me';
import { usePrefs } from '@/state/prefs';
import { Button } from '@/ui/button';
import { TextField } from '@/ui/text-field';
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

const isOpen = (offer: ModelOffer) => offer.language.endsWith(':');
const provider = (offer: ModelOffer) => offer.language.split(':')[1] ?? '';
const model = (offer: ModelOffer) => (offer.language.split('@http')[0] ?? '').split(':').slice(2).join(':');

/** What else could understand people here; asked for only where this person may choose it. */
function useOffers(wanted: boolean): readonly ModelOffer[] {
  const offline = useWorld((world) => world.info?.offline_language ?? false);
  const may = useMay('setting');
  const found = useRequest(offline && may && wanted ? 'models' : '', getModels);
  return found.state === 'ready' && Array.isArray(found.value) ? found.value : [];
}

/** Offers a model that is on this machine, or whose key is; it is used only when somebody says so. */
export function ModelNote() {
  const { t } = useTranslation('menu');
  const { modelNoted, set } = usePrefs();
  const [isAmongSettings] = useRoute(pathOf('settings')); // there it stands anyway
  const isWanted = !modelNoted && !isAmongSettings;
  const [offer] = useOffers(isWanted);
  if (!offer || !isWanted) return null;
  return (
    <div className={css.offer}>
      <Offer offer={offer} />
      <Button onPress={() => set({ modelNoted: true })}>{t('notNow')}</Button>
    </div>
  );
}

/** All that is offered, and the way back from what was chosen. */
export function Models() {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const may = useMay('setting');
  const offers = useOffers(true);
  return (
    <>
      {offers.map((offer) => (
        <div className={css.model} key={offer.language}>
          <Offer offer={offer} />
        </div>
      ))}
      {info?.is_language_chosen && may && <Button onPress={() => void attempt(() => putModel(''))}>{t('useFirst')}</Button>}
    </>
  );
}

function Offer({ offer }: { offer: ModelOffer }) {
  const { t } = useTranslation('menu');
  const here = useWorld((world) => world.info?.can_choose_language ?? false);
  const told = isOpen(offer) ? t('keyFound', offer) : t('modelFound', { model: model(offer), found: offer.found });
  const option = `--language ${offer.language}${isOpen(offer) ? t('nameOfModel') : ''}`;
  return (
    <>
      <p>
        {told} {here ? t('modelHere') : t('modelStart')} {!here && <code>{option}</code>}
      </p>
      {!here && <Button onPress={() => void navigator.clipboard.writeText(option)}>{t('copy')}</Button>}
      {here && isOpen(offer) && <ModelName offer={offer} />}
      {here && !isOpen(offer) && <Button onPress={() => void attempt(() => putModel(offer.language))}>{t('useModel')}</Button>}
    </>
  );
}

/** Which of its models is for people to choose. */
function ModelName({ offer }: { offer: ModelOffer }) {
  const { t } = useTranslation('menu');
  const [name, setName] = useState('');
  return (
    <form
      className={css.model}
      onSubmit={(event) => {
        event.preventDefault();
        if (name.trim()) void attempt(() => putModel(offer.language + name.trim()));
      }}
    >
      <TextField label={t('modelOf', { provider: provider(offer) })} value={name} onChange={setName} />
      <Button type="submit" isDisabled={!name.trim()}>
        {t('useModel')}
      </Button>
    </form>
  );
}
