import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { addPerson, changePerson, getPeople, makeCode, removePerson, revokeDevice } from '@/live/people-api';
import type { CodeInfo, PersonInfo, Role } from '@/live/types';
import { attempt } from '@/state/do';
import { useMe } from '@/state/me';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Dialog, DialogButtons } from '@/ui/dialog';
import { Empty, Panel } from '@/ui/panel';
import { TextField } from '@/ui/text-field';
import { useKept, useRequest } from '@/ui/use-request';

import { DeviceList } from './device-list';
import css from './people.module.css';

const ROLES: readonly Role[] = ['viewer', 'operator', 'supervisor'];

/** Everybody who may come in, for supervisors. @param onChanged Called when it may have changed who I am. */
export function PeoplePage({ onChanged }: { onChanged: () => void }) {
  const { t } = useTranslation(['people', 'common']);
  const [asked, setAsked] = useState(0);
  const found = useKept(useRequest(`people ${asked}`, getPeople));
  const way = useMe(({ session }) => session?.way);
  const change = async (deed: () => Promise<unknown>) => {
    const done = await attempt(deed);
    setAsked((count) => count + 1);
    onChanged();
    return done;
  };
  return (
    <Panel title={t('title')}>
      <div className={css.page}>
        {found.state === 'failed' && <Empty title={found.reason} />}
        {found.state === 'ready' && (
          <>
            {way === 'open' && <p>{t('open')}</p>}
            <ul className={css.list}>
              {(found.value.people ?? []).map((person) => (
                <PersonCard key={person.name} person={person} change={change} />
              ))}
            </ul>
            <AddPerson isFirst={(found.value.people ?? []).length === 0} change={change} />
            {way !== 'open' && (
              <section className={css.section}>
                <h3>{t('devices')}</h3>
                <DeviceList owners devices={found.value.devices ?? []} onEnd={(device) => void change(() => revokeDevice(device.id))} />
                {way !== 'password' && <Pairing />}
              </section>
            )}
          </>
        )}
      </div>
    </Panel>
  );
}

type Change = (deed: () => Promise<unknown>) => Promise<boolean>;

function useRoles() {
  const { t } = useTranslation('people');
  return ROLES.map((id) => ({ id, label: t(`roles.${id}`) }));
}

function PersonCard({ person, change }: { person: PersonInfo; change: Change }) {
  const { t } = useTranslation(['people', 'common']);
  const roles = useRoles();
  const [asking, setAsking] = useState<'password' | 'remove' | null>(null);
  const [password, setPassword] = useState('');
  const { name } = person;
  const close = () => {
    setAsking(null);
    setPassword('');
  };
  return (
    <li className={css.item} data-disabled={person.disabled} aria-label={name}>
      <div className={css.words}>
        <strong>{name}</strong>
        {person.disabled && <span className={css.quiet}>{t('isDisabled')}</span>}
      </div>
      <Choice label={t('roleOf', { name })} hideLabel value={person.role} options={roles} onChange={(role) => void change(() => changePerson(name, { role }))} />
      <Button aria-label={t('resetPasswordOf', { name })} onPress={() => setAsking('password')}>
        {t('resetPassword')}
      </Button>
      <Button
        aria-label={t(person.disabled ? 'enableOf' : 'disableOf', { name })}
        onPress={() => void change(() => changePerson(name, { disabled: !person.disabled }))}
      >
        {t(person.disabled ? 'enable' : 'disable')}
      </Button>
      <Button aria-label={t('removeOf', { name })} onPress={() => setAsking('remove')}>
        {t('remove')}
      </Button>
      <Dialog role="alertdialog" title={t('removeOf', { name })} isOpen={asking === 'remove'} onClose={close}>
        <p>{t('removeText')}</p>
        <DialogButtons>
          <Button onPress={close}>{t('common:cancel')}</Button>
          <Button tone="danger" onPress={() => void change(() => removePerson(name)).then(close)}>
            {t('remove')}
          </Button>
        </DialogButtons>
      </Dialog>
      <Dialog title={t('resetPasswordOf', { name })} isOpen={asking === 'password'} onClose={close}>
        <TextField label={t('newPassword')} help={t('passwordHelp')} type="password" autoComplete="new-password" value={password} onChange={setPassword} />
        <DialogButtons>
          <Button onPress={close}>{t('common:cancel')}</Button>
          <Button tone="main" isDisabled={password === ''} onPress={() => void change(() => changePerson(name, { password })).then((done) => done && close())}>
            {t('changePassword')}
          </Button>
        </DialogButtons>
      </Dialog>
    </li>
  );
}

function AddPerson({ isFirst, change }: { isFirst: boolean; change: Change }) {
  const { t } = useTranslation('people');
  const roles = useRoles();
  const [name, setName] = useState('');
  const [password, setPassword] = useState('');
  const [role, setRole] = useState<Role>('operator');
  const add = async () => {
    if (await change(() => addPerson(name, role, password))) {
      setName('');
      setPassword('');
    }
  };
  return (
    <form
      className={css.form}
      onSubmit={(event) => {
        event.preventDefault();
        void add();
      }}
    >
      <h3>{t('add')}</h3>
      {isFirst && <p>{t('first')}</p>}
      <TextField label={t('name')} autoComplete="off" maxLength={60} value={name} onChange={setName} />
      <TextField label={t('password')} help={t('passwordHelp')} type="password" autoComplete="new-password" value={password} onChange={setPassword} />
      {!isFirst && <Choice label={t('role')} value={role} options={roles} onChange={setRole} />}
      {!isFirst && <p className={css.quiet}>{t(`roleHelp.${role}`)}</p>}
      <Button tone="main" type="submit" isDisabled={name.trim() === '' || password === ''}>
        {t('addNow')}
      </Button>
    </form>
  );
}

function Pairing() {
  const { t } = useTranslation('people');
  const roles = useRoles();
  const [role, setRole] = useState<Role>('operator');
  const [made, setMade] = useState<CodeInfo | null>(null);
  return (
    <div className={css.form}>
      <h4>{t('pair')}</h4>
      <p>{t('pairText')}</p>
      <Choice label={t('deviceRole')} value={role} options={roles} onChange={setRole} />
      <Button onPress={() => void attempt(async () => setMade(await makeCode(role)))}>{t('makeCode')}</Button>
      <p role="status">{made && <strong className={css.code}>{t('code', { code: made.code })}</strong>}</p>
    </div>
  );
}
