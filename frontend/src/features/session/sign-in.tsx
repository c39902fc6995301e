import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { ApiError, openSession } from '@/live/api';
import { browserHasPasskeys, enterWithPasskey } from '@/live/people-api';
import { explain } from '@/state/do';
import { useMe } from '@/state/me';
import { Button } from '@/ui/button';
import { TextField } from '@/ui/text-field';

import css from './sign-in.module.css';

/** A code that came with the address, as in the picture that phones are shown: `#code=ABCD-EFGH`. */
const codeOfAddress = () => /^#code=(.+)$/.exec(window.location.hash)?.[1] ?? '';

/** Asks for what lets one in here: an account, the password, or a code. */
export function SignIn({ onSignedIn }: { onSignedIn: () => void }) {
  const { t } = useTranslation('session');
  const way = useMe(({ session }) => session?.way ?? 'code');
  const passkeys = useMe(({ session }) => session?.passkeys ?? false) && browserHasPasskeys();
  const [secret, setSecret] = useState(codeOfAddress);
  const [name, setName] = useState('');
  const [problem, setProblem] = useState('');
  const [busy, setBusy] = useState(false);
  const account = way === 'account';

  const enter = async (deed: () => Promise<unknown>, wrong: string) => {
    setBusy(true);
    try {
      await deed();
      if (codeOfAddress() !== '') window.location.hash = '#/';
      onSignedIn();
    } catch (error) {
      setProblem(error instanceof ApiError && error.status !== 401 ? explain(error) : wrong);
      setSecret('');
    } finally {
      setBusy(false);
    }
  };

  const who = account ? (
    <TextField label={t('account')} autoComplete="username" autoFocus maxLength={60} value={name} onChange={setName} />
  ) : (
    <TextField label={t('name')} help={t('nameHelp')} autoComplete="name" maxLength={60} value={name} onChange={setName} />
  );

  return (
    <main className={css.page}>
      <form
        className={css.card}
        onSubmit={(event) => {
          event.preventDefault();
          void enter(() => openSession(secret, name), t('wrong'));
        }}
      >
        <h1>{t('title')}</h1>
        <p>{t(account ? 'textAccount' : way === 'password' ? 'textPassword' : 'text')}</p>
        {account && who}
        <TextField
          label={t('secret')}
          type="password"
          autoComplete="current-password"
          autoFocus={!account && secret === ''}
          value={secret}
          onChange={setSecret}
        />
        {!account && who}
        <p role="alert" className={css.problem}>
          {problem}
        </p>
        <Button tone="main" type="submit" isDisabled={secret === '' || busy}>
          {t('signIn')}
        </Button>
        {account && passkeys && (
          <Button isDisabled={busy} onPress={() => void enter(enterWithPasskey, t('passkeyFailed'))}>
            {t('withPasskey')}
          </Button>
        )}
      </form>
    </main>
  );
}
