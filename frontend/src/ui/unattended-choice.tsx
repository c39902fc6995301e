import { useTranslation } from 'react-i18next';
import { create } from 'zustand';

import type { Unattended } from '@/live/api';
import { useWorld } from '@/live/store';
import { Choice } from '@/ui/choice';

import css from './composer.module.css';

interface Chosen {
  /** Null: as the system does otherwise. */
  choice: Unattended | null;
  choose: (choice: Unattended) => void;
}

/** What was chosen for the orders of this page. */
export const useUnattended = create<Chosen>()((set) => ({ choice: null, choose: (choice) => set({ choice }) }));

const choices: readonly Unattended[] = ['go_on', 'hold', 'go_home'];

/** What robots do with an order when nobody is connected any more. */
export function UnattendedChoice() {
  const { t } = useTranslation('chat');
  const { choice, choose } = useUnattended();
  const info = useWorld((world) => world.info);
  if (!info) return null;
  return (
    <div className={css.unattended}>
      <Choice
        label={t('unattended', { seconds: info.unattended_after_s })}
        value={choice ?? info.unattended}
        options={choices.map((id) => ({ id, label: t(`unattendedChoices.${id}`) }))}
        onChange={choose}
      />
    </div>
  );
}
