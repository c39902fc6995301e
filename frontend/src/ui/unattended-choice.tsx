import { useTranslation } from 'react-i18next';

import type { Unattended } from '@/live/api';
import { useWorld } from '@/live/store';
import { useMay } from '@/state/me';
import { useUnattended } from '@/state/unattended';

import { Choice } from './choice';

const choices: readonly Unattended[] = ['go_on', 'hold', 'go_home'];

/** What robots do with an order of this page when nobody is connected any more. */
export function UnattendedChoice() {
  const { t } = useTranslation('chat');
  const { choice, choose } = useUnattended();
  const info = useWorld((world) => world.info);
  const may = useMay('speak');
  if (!info || !may) return null;
  return (
    <Choice
      label={t('unattended', { seconds: info.unattended_after_s })}
      value={choice ?? info.unattended}
      options={choices.map((id) => ({ id, label: t(`unattendedChoices.${id}`) }))}
      onChange={choose}
    />
  );
}
