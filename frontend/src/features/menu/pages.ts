/** The pages one can go to, in order. */
import type { ServerInfo } from '@/live/types';
import type { Effect } from '@/state/me';

export const pages = [
  'chat', 'plan', 'display', 'map', 'memory', 'robots', 'rules', 'incidents', 'log', 'people', 'settings',
] as const;

export type Page = (typeof pages)[number];

export const pathOf = (page: Page) => (page === 'chat' ? '/' : `/${page}`);

const needs: Partial<Record<Page, Effect>> = { people: 'people' };

/** Pages that this server has; a part that is switched off there has none. */
export const here = (info: ServerInfo | null): readonly Page[] => pages.filter((page) => info?.modules?.[page] !== false);

/** Those of them that this visitor may look at. */
export const offered = (info: ServerInfo | null, may: (effect: Effect) => boolean): readonly Page[] =>
  here(info).filter((page) => !needs[page] || may(needs[page]));
