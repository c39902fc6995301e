/** The pages one can go to, in order. */
import type { ServerInfo } from '@/live/types';
import type { Effect } from '@/state/me';

export const pages = [
  'chat', 'plan', 'display', 'map', 'memory', 'robots', 'rules', 'incidents', 'log', 'people', 'settings',
] as const;

export type Page = (typeof pages)[number];

export const pathOf = (page: Page) => (page === 'chat' ? '/' : `/${page}`);

/** Pages that this server offers; a part that is switched off there has none. */
export function offered(info: ServerInfo | null, may: (effect: Effect) => boolean): readonly Page[] {
  return pages.filter((page) => info?.modules?.[page] !== false && (page !== 'people' || may('people')));
}
