import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';

import { App } from './app/app';
import { keepShell } from './app/keep-shell';
import { startWords } from './i18n';
import { listenForOffer } from './state/install';
import { applyLook, usePrefs } from './state/prefs';
import './styles/tokens.css';
import './styles/base.css';

const root = document.getElementById('root');
if (!root) throw new Error('the page has no element with the id "root"');

listenForOffer();
applyLook(usePrefs.getState());
await startWords(usePrefs.getState().language);
createRoot(root).render(
  <StrictMode>
    <App />
  </StrictMode>,
);
void keepShell();
