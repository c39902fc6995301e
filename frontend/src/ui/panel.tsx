import { useTranslation } from 'react-i18next';

import { useLive } from '@/live/store';

import css from './panel.module.css';

interface Props {
  title: string;
  /** What stands right of the title. */
  tools?: React.ReactNode;
  children: React.ReactNode;
  /** Let the content run to the edges. */
  flush?: boolean;
  /** Without a heading to be seen. */
  bare?: boolean;
}

/** A part of the page with a heading; fills the place it is given and scrolls inside. */
export function Panel({ title, tools, children, flush = false, bare = false }: Props) {
  return (
    <section className={css.panel} aria-label={title}>
      {bare ? (
        <h2 className="hidden">{title}</h2>
      ) : (
        <header className={css.head}>
          <h2>{title}</h2>
          {tools && <div className={css.tools}>{tools}</div>}
        </header>
      )}
      {flush ? (
        <div className={css.flush}>{children}</div>
      ) : (
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys
        <div className={css.body} tabIndex={0} role="group" aria-label={title}>
          {children}
        </div>
      )}
    </section>
  );
}

/** What a part shows while it has nothing. */
export function Empty({ title, children }: { title: string; children?: React.ReactNode }) {
  return (
    <div className={css.empty}>
      <p className={css.emptyTitle}>{title}</p>
      {children}
    </div>
  );
}

/** What a part shows until it knows what there is; without a connection, that there is none. */
export function Loading() {
  const { t } = useTranslation('common');
  const lost = useLive((live) => live.connection === 'lost');
  return <Empty title={lost ? t('offline') : t('loading')} />;
}
