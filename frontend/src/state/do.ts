/** Ask the server for something and tell the person if it did not work. */
import i18next from 'i18next';

import { ApiError } from '@/live/api';

import { untilReached, useToasts } from './toasts';

/** What a failed request says to people. */
export function explain(error: unknown): string {
  if (!(error instanceof ApiError)) throw error;
  if (error.status === 0) return i18next.t('common:notReached');
  return [error.message || i18next.t('common:refused'), error.remedy].filter(Boolean).join(' ');
}

/** @returns Whether it worked; if not, the reason was shown. */
export async function attempt(deed: () => Promise<unknown>): Promise<boolean> {
  useToasts.getState().anew();
  try {
    await deed();
    return true;
  } catch (error) {
    const message = explain(error);
    const unreached = error instanceof ApiError && error.status === 0;
    useToasts.getState().show({ tone: 'error', message, stands: unreached ? untilReached() : 'deed' });
    return false;
  }
}
