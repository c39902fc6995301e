import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { closeSession } from '@/live/api';
import {
  browserHasPasskeys,
  changeMyPassword,
  closeAllMyDevices,
  closeMyDevice,
  getMe,
  makePasskey,
  removePasskey,
} from '@/live/people-api';
import type { MyAccount } from '@/live/types';
import { attempt } from '@/state/do';
import { useMe } from '@/state/me';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';
import { TextField } from '@/ui/text-field';
import { useKept, useRequest } from '@/ui/use-request';

import { DeviceList } from './device-list';
import css from './people.module.css';

/** Oneself: who one is here, password, passkeys, devices, signing out. */
export function MyAccountSection({ onSignedOut }: { onSignedOut: () => void }) {
  const { t } = useTranslation(['people', 'session']);
  const session = useMe((me) => me.session);
  const [asked, setAsked] = useState(0);
  const again = () => setAsked((count) => count + 1);
  const me = useKept(useRequest(`me ${asked}`, getMe));
  const out = (deed: () => Promise<unknown>) => void attempt(deed).then((done) => done && onSignedOut());
  return (
    <section className={css.section}>
      <h3>{t('you')}</h3>
      {session?.role && <p>{t('youAre', { name: session.name || t('unnamed'), role: t(`roles.${session.role}`) })}</p>}
      {me.state === 'ready' && me.value.account && (
        <>
          <MyPasswordForm />
          <Passkeys account={me.value} onChanged={again} />
        </>
      )}
      {me.state === 'ready' && (
        <>
          <h4>{t('myDevices')}</h4>
          <DeviceList
            devices={me.value.devices ?? []}
            onEnd={(device) => void attempt(() => closeMyDevice(device.id)).then((done) => done && (device.here ? onSignedOut() : again()))}
          />
        </>
      )}
      <div className={css.row}>
        <Button onPress={() => out(closeSession)}>{t('session:signOut')}</Button>
        <Button onPress={() => out(closeAllMyDevices)}>{t('signOutEverywhere')}</Button>
      </div>
    </section>
  );
}

function MyPasswordForm() {
  const { t } = useTranslation('people');
  const show = useToasts((state) => state.show);
  const [old, setOld] = useState('');
  const [wanted, setWanted] = useState('');
  const save = async () => {
    if (await attempt(() => changeMyPassword(old, wanted))) {
      setOld('');
      setWanted('');
      show({ tone: 'info', message: t('passwordChanged') });
    }
  };
  return (
    <form
      className={css.form}
      onSubmit={(event) => {
        event.preventDefault();
        void save();
      }}
    >
      <h4>{t('myPassword')}</h4>
      <TextField label={t('oldPassword')} type="password" autoComplete="current-password" value={old} onChange={setOld} />
      <TextField label={t('newPassword')} help={t('passwordHelp')} type="password" autoComplete="new-password" value={wanted} onChange={setWanted} />
      <Button type="submit" isDisabled={old === '' || wanted === ''}>
        {t('changePassword')}
      </Button>
    </form>
  );
}

function Passkeys({ account, onChanged }: { account: MyAccount; onChanged: () => void }) {
  const { t } = useTranslation('people');
  const possible = useMe(({ session }) => session?.passkeys ?? false) && browserHasPasskeys();
  const show = useToasts((state) => state.show);
  const [name, setName] = useState('');
  const make = async () => {
    try {
      await attempt(() => makePasskey(name));
      setName('');
      onChanged();
    } catch {
      show({ tone: 'error', message: t('passkeyNotMade'), stands: 'deed' });
    }
  };
  return (
    <>
      <h4>{t('passkeys')}</h4>
      <ul className={css.list}>
        {(account.passkeys ?? []).map((passkey) => (
          <li key={passkey.id} className={css.item}>
            <strong className={css.words}>{passkey.name}</strong>
            <Button
              aria-label={t('removePasskey', { name: passkey.name })}
              onPress={() => void attempt(() => removePasskey(passkey.id)).then(onChanged)}
            >
              {t('remove')}
            </Button>
          </li>
        ))}
      </ul>
      {possible ? (
        <form
          className={css.form}
          onSubmit={(event) => {
            event.preventDefault();
            void make();
          }}
        >
          <TextField label={t('passkeyName')} help={t('passkeyHelp')} maxLength={60} value={name} onChange={setName} />
          <Button type="submit" isDisabled={name.trim() === ''}>
            {t('makePasskey')}
          </Button>
        </form>
      ) : (
        <p className={css.quiet}>{t('noPasskeys')}</p>
      )}
    </>
  );
}
