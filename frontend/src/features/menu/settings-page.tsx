import { useTranslation } from 'react-i18next';

import { languages, nameOfLanguage } from '@/i18n';
import { useWorld } from '@/live/store';
import { useForeign } from '@/state/foreign';
import { usePrefs, type PlanColours, type Theme } from '@/state/prefs';
import { Choice } from '@/ui/choice';
import { Panel } from '@/ui/panel';

import { InstallHint } from './install-hint';
import { LoudChoice } from './loud-choice';
import css from './settings-page.module.css';
import { Models } from './understands';

const themes: readonly Theme[] = ['system', 'light', 'dark', 'contrast'];
const colours: readonly PlanColours[] = ['standard', 'traffic'];
const tongues = Object.keys(languages).map((id) => ({ id, label: nameOfLanguage(id) }));
const NO_ADDRESSES: readonly string[] = [];

/** Choices of this person, and what there is to know of the system. @param children What stands below. */
export function SettingsPage({ children }: { children?: React.ReactNode }) {
  const { t } = useTranslation('menu');
  const prefs = usePrefs();
  return (
    <Panel title={t('settings')}>
      <div className={css.settings}>
        <Choice label={t('language')} value={prefs.language} options={tongues} onChange={(language) => prefs.set({ language })} />
        <Choice
          label={t('theme')}
          value={prefs.theme}
          options={themes.map((id) => ({ id, label: t(`themes.${id}`) }))}
          onChange={(theme) => prefs.set({ theme })}
        />
        <Choice
          label={t('planColours')}
          value={prefs.planColours}
          options={colours.map((id) => ({ id, label: t(`colours.${id}`) }))}
          onChange={(planColours) => prefs.set({ planColours })}
        />
        <LoudChoice />
        <About />
        <InstallHint />
        {children}
      </div>
    </Panel>
  );
}

function About() {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const addresses = info?.addresses ?? NO_ADDRESSES;
  const foreign = useForeign();
  if (!info) return null;
  return (
    <>
      <dl className={css.about}>
        {!info.offline_language && (
          <>
            <dt>{t('understands')}</dt>
            <dd>{info.language}</dd>
          </>
        )}
        <dt>{t('version')}</dt>
        <dd>{info.version}</dd>
      </dl>
      {info.offline_language && <p>{t('offlineLanguage')}</p>}
      {foreign && <p>{t('foreignHelp')}</p>}
      <Models />
      <section className={css.devices}>
        <h3>{t('otherDevices')}</h3>
        {addresses.length === 0 ? (
          <p>{t('onlyHere')}</p>
        ) : (
          <>
            <p>{t('otherDevicesText')}</p>
            <img src="/api/qr.svg" alt={t('qrAlt')} width={180} height={180} />
            <ul>
              {addresses.map((address) => (
                <li key={address}>{address}</li>
              ))}
            </ul>
          </>
        )}
      </section>
    </>
  );
}
