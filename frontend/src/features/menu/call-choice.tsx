import { useEffect, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { attempt } from '@/state/do';
import { beginCalling, callingNow, endCalling, type Calling } from '@/state/push';
import { Button } from '@/ui/button';

/** Whether this device is called while the page is closed. */
export function CallChoice() {
  const { t } = useTranslation('menu');
  const [calling, setCalling] = useState<Calling | 'refused' | null>(null);
  useEffect(() => {
    void callingNow().then(setCalling);
  }, []);
  const turn = () =>
    void attempt(async () => {
      if (calling === 'on') {
        await endCalling();
        setCalling('off');
      } else setCalling((await beginCalling()) ? 'on' : 'refused');
    });
  if (calling === null) return null;
  return (
    <>
      <p role="status">{t(`call.${calling}`)}</p>
      {calling !== 'impossible' && (
        <Button aria-pressed={calling === 'on'} onPress={turn}>
          {t(calling === 'on' ? 'callEnd' : 'callBegin')}
        </Button>
      )}
    </>
  );
}
