import { useEffect } from 'react';
import { useTranslation } from 'react-i18next';

import { useToasts, type Toast } from '@/state/toasts';
import { Button } from '@/ui/button';

import css from './toasts.module.css';

const SHOWN_MS = 8000;
/** Whoever may want something back needs a moment to see that. */
const WITH_ACTION_MS = 20_000;

/** Short notes at the edge; those with a failure stay until they are put away. */
export function Toasts() {
  const { t } = useTranslation('common');
  const toasts = useToasts((state) => state.toasts);
  return (
    <section className={css.place} aria-label={t('notes')} aria-live="polite">
      <div className={css.toasts}>
        {toasts.map((toast) => (
          <Note key={toast.id} toast={toast} />
        ))}
      </div>
    </section>
  );
}

function Note({ toast }: { toast: Toast }) {
  const { t } = useTranslation('common');
  const dismiss = useToasts((state) => state.dismiss);
  const { id, tone, message, action } = toast;
  useEffect(() => {
    if (tone === 'error') return undefined;
    const timer = setTimeout(() => dismiss(id), action ? WITH_ACTION_MS : SHOWN_MS);
    return () => clearTimeout(timer);
  }, [id, tone, action, dismiss]);
  return (
    <div className={css.toast} data-comes data-tone={tone} role={tone === 'error' ? 'alert' : undefined}>
      <p>{message}</p>
      {action && (
        <Button
          onPress={() => {
            action.run();
            dismiss(id);
          }}
        >
          {action.label}
        </Button>
      )}
      <Button tone="quiet" icon="close" iconOnly aria-label={t('dismiss')} onPress={() => dismiss(id)} />
    </div>
  );
}
