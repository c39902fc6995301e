import { useTranslation } from 'react-i18next';

import type { ChatEntry } from '@/live/types';
import { isOwn } from '@/state/outbox';

const DEVICES = ['page on a computer', 'page on a phone', 'page on a tablet', 'a program', 'terminal'] as const;

/** What a person is called who said something: by name, or where nobody has one, oneself or somebody elsewhere. */
export function useSpeaker() {
  const { t } = useTranslation('chat');
  return ({ author, device, id }: ChatEntry) => {
    if (author) return author;
    const elsewhere = DEVICES.find((one) => one === device);
    return isOwn(id) ? t('you') : t(elsewhere ? `somebodyAt.${elsewhere}` : 'somebody');
  };
}

/** What is alike in all that one speaker says without a break. */
export const speakerKey = ({ who, author, device, id, targets }: ChatEntry) => [who, author, device, who === 'operator' && isOwn(id), ...targets].join('\n');
