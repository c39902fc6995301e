import { useTranslation } from 'react-i18next';

import type { DeviceInfo } from '@/live/types';
import { Button } from '@/ui/button';

import css from './people.module.css';

interface Props {
  devices: readonly DeviceInfo[];
  /** Whether it is said whose they are. */
  owners?: boolean;
  onEnd: (device: DeviceInfo) => void;
}

/** Browsers in which somebody is signed in, with a way to end that. */
export function DeviceList({ devices, owners = false, onEnd }: Props) {
  const { t, i18n } = useTranslation(['people', 'common']);
  const when = (ms: number) => new Date(ms).toLocaleString(i18n.language, { dateStyle: 'medium', timeStyle: 'short' });
  return (
    <ul className={css.list}>
      {devices.map((device) => {
        const kind = device.here ? t(`this.${device.kind}`) : t(`kinds.${device.kind}`);
        const who = device.name || t('unnamed');
        const label = owners ? `${who}: ${kind}` : kind;
        return (
          <li key={device.id} className={css.item}>
            <div className={css.words}>
              <strong>{label}</strong>
              <span className={css.quiet}>
                {[device.browser, device.paired ? t('paired', { role: t(`roles.${device.role}`) }) : '', t('seen', { when: when(device.seen_unix_ms) })]
                  .filter(Boolean)
                  .join(' · ')}
              </span>
            </div>
            <Button aria-label={t('endOf', { device: label })} onPress={() => onEnd(device)}>
              {t('end')}
            </Button>
          </li>
        );
      })}
    </ul>
  );
}
