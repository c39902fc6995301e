import { useTranslation } from 'react-i18next';

import type { ChatEntry } from '@/live/types';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import css from './choices.module.css';

interface Props {
  entry: ChatEntry;
  onChoose: (entry: ChatEntry, choice: string) => void;
  isStop?: boolean;
}

/** What can be tapped for an answer. */
export function Choices({ entry, onChoose, isStop = true }: Props) {
  const { t } = useTranslation('chat');
  if (entry.choices.length === 0) return null;
  return (
    <div className={css.choices} role="group" aria-label={t('choices')}>
      {entry.choices.map((choice, index) => (
        <Button needs="speak" key={choice} excludeFromTabOrder={!isStop} onPress={() => onChoose(entry, choice)}>
          {entry.choices.length > 1 && <span aria-hidden="true" className={css.number}>{index + 1}</span>}
          {sentence(entry.shown_choices?.[index] ?? choice)}
        </Button>
      ))}
    </div>
  );
}
