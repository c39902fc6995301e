import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { attempt } from '@/state/do';
import { useStopping } from '@/state/stopping';
import { Button } from '@/ui/button';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { nameList } from '@/ui/words';

/** The way out of a stop, for one robot or several; asks whether it is safe. */
export function Release({ names, label }: { names: readonly string[]; label: string }) {
  const { t, i18n } = useTranslation(['stop', 'common']);
  const [asking, setAsking] = useState(false);
  const reset = useStopping((state) => state.reset);
  const name = nameList(names, i18n.language);
  const several = names.length > 1;
  const title = several ? t('resetTitleMany', { count: names.length }) : t('resetTitle', { name });
  return (
    <>
      <Button needs="reset" onPress={() => setAsking(true)}>{label}</Button>
      <Dialog role="alertdialog" title={title} isOpen={asking} onClose={() => setAsking(false)}>
        <p>{several ? t('resetTextMany', { names: name }) : t('resetText', { name })}</p>
        <DialogButtons>
          <Button autoFocus onPress={() => setAsking(false)}>
            {t('common:cancel')}
          </Button>
          <Button
            tone="main"
            onPress={() => {
              setAsking(false);
              void attempt(() => reset(names));
            }}
          >
            {t('resetYes')}
          </Button>
        </DialogButtons>
      </Dialog>
    </>
  );
}
