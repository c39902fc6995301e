import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { ApiError, openSession } from '@/live/api';
import { explain } from '@/state/do';
import { Button } from '@/ui/button';
import { TextField } from '@/ui/text-field';

import css from './sign-in.module.css';

/** A code that came with the address, as in the picture that phones are shown: `#code=ABCD-EFGH`. */
const codeOfAddress = () => /^#code=(.+)$/.exec(window.location.hash)?.[1] ?? '';

/** Asks for the password or code. */
export function SignIn({ onSignedIn }: { onSignedIn: () => void }) {
  const { t } = useTranslation('session');
  const [secret, setSecret] = useState(codeOfAddress);
  const [name, setName] = useState('');
  const [problem, setProblem] = useState('');
  const [busy, setBusy] = useState(false);

  const submit = async () => {
    setBusy(true);
    try {
      await openSession(secret, name);
      if (codeOfAddress() !== '') window.location.hash = '#/';
      onSignedIn();
    } catch (error) {
      setProblem(error instanceof ApiError && error.status === 401 ? t('wrong') : explain(error));
      setSecret('');
    } finally {
      setBusy(false);
    }
  };

  return (
    <main className={css.page}>
      <form
        className={css.card}
        onSubmit={(event) => {
          event.preventDefault();
          void submit();
        }}
      >
        <h1>{t('title')}</h1>
        <p>{t('text')}</p>
        <TextField
          label={t('secret')}
          type="password"
          autoComplete="current-password"
          autoFocus={secret === ''}
          value={secret}
          onChange={setSecret}
        />
        <TextField label={t('name')} help={t('nameHelp')} autoComplete="name" maxLength={60} value={name} onChange={setName} />
        <p role="alert" className={css.problem}>
          {problem}
        </p>
        <Button tone="main" type="submit" isDisabled={secret === '' || busy}>
          {t('signIn')}
        </Button>
      </form>
    </main>
  );
}
