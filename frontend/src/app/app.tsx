import i18next from 'i18next';
import { useEffect } from 'react';
import { I18nProvider } from 'react-aria-components';
import { Router } from 'wouter';

import { SignIn } from '@/features/session';
import { connect } from '@/live/connection';
import { keepStopLine } from '@/live/stop-line';
import { applyLook, usePrefs } from '@/state/prefs';
import { keepFocus } from '@/ui/keep-focus';
import { useDoublePress } from '@/ui/use-double-press';
import { useHashPath } from '@/ui/use-hash';

import { Shell } from './shell';
import { useSession } from './use-session';

/** The whole page: signed in or not, in the chosen look and language. */
export function App() {
  const { theme, planColours, language } = usePrefs();
  const session = useSession();
  useEffect(() => {
    applyLook({ theme, planColours, language });
    if (i18next.language !== language) void i18next.changeLanguage(language);
  }, [theme, planColours, language]);
  const { state, refresh } = session;
  useEffect(() => (state === 'open' ? connect(language, refresh) : undefined), [state, refresh, language]);
  useEffect(() => (state === 'open' ? keepStopLine() : undefined), [state]);
  useEffect(keepFocus, []);
  useDoublePress();
  return (
    <I18nProvider locale={language === 'en' ? 'en-GB' : language}>
      <Router hook={useHashPath}>
        {session.state === 'locked' ? (
          <SignIn onSignedIn={session.refresh} />
        ) : (
          <Shell canSignOut={session.required} onSessionChanged={session.refresh} />
        )}
      </Router>
    </I18nProvider>
  );
}
