import { useTranslation } from 'react-i18next';

import { draftKey, useDrafts } from '@/state/drafts';
import { Button } from '@/ui/button';

import css from './entry.module.css';
import { goesOn, useOutbox, type Outgoing } from '@/state/outbox';

/** A message that is not yet part of the conversation. */
export function PendingEntry({ message }: { message: Outgoing }) {
  const { t } = useTranslation(['chat', 'stop']);
  const { retry, discard } = useOutbox();
  const failed = message.state === 'failed';
  const isRepeated = goesOn(message);
  const why = isRepeated ? t('stop:late') : `${t('failed')}. ${message.reason}`;
  const change = () => {
    useDrafts.getState().add(draftKey(message.targets), message.text);
    discard(message.id);
  };
  return (
    <li className={css.entry} data-mine="true">
      <div className={css.said}>
        <p className={css.text}>{message.text || message.images.map((image) => image.name).join(', ')}</p>
      </div>
      <div className={css.waiting} data-failed={failed} role={failed ? 'alert' : undefined}>
        <span>{failed ? why : t('sending')}</span>
        {failed && (
          <>
            {message.refused && <Button onPress={change}>{t('edit')}</Button>}
            {!message.refused && !isRepeated && <Button onPress={() => void retry(message.id)}>{t('retry')}</Button>}
            <Button tone="quiet" onPress={() => discard(message.id)}>
              {t(isRepeated ? 'stop:callOff' : 'discard')}
            </Button>
          </>
        )}
      </div>
    </li>
  );
}
