import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { addRobot } from '@/live/api';
import { attempt } from '@/state/do';
import { useOverlays } from '@/state/overlays';
import { useSelectionStore } from '@/state/selection';
import { Button } from '@/ui/button';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { TextField } from '@/ui/text-field';

import css from './robots.module.css';

/** Asks for the name of a robot that has not appeared by itself. */
export function AddRobot() {
  const { t } = useTranslation(['chat', 'common']);
  const { open, set } = useOverlays();
  const only = useSelectionStore((state) => state.only);
  const [name, setName] = useState('');
  const close = () => {
    set('none');
    setName('');
  };
  const submit = async () => {
    const wanted = name.trim();
    if (wanted && (await attempt(() => addRobot(wanted)))) {
      only(wanted);
      close();
    }
  };
  return (
    <Dialog title={t('addRobot')} isOpen={open === 'addRobot'} onClose={close}>
      <form
        className={css.list}
        onSubmit={(event) => {
          event.preventDefault();
          void submit();
        }}
      >
        <TextField label={t('addRobotName')} help={t('addRobotHelp')} value={name} onChange={setName} autoFocus maxLength={60} />
        <DialogButtons>
          <Button onPress={close}>{t('common:cancel')}</Button>
          <Button tone="main" type="submit" isDisabled={name.trim() === ''}>
            {t('common:add')}
          </Button>
        </DialogButtons>
      </form>
    </Dialog>
  );
}
