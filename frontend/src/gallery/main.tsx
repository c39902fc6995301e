/** Shows one story at a time, chosen by the address: /gallery#Map. Only while the page is being developed. */
import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';

import { startWords } from '@/i18n';
import { snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { applyLook, usePrefs } from '@/state/prefs';
import '@/styles/base.css';
import '@/styles/tokens.css';

import css from './gallery.module.css';
import { network } from './network';
import { stories } from './stories';

const chosen = decodeURIComponent(window.location.hash.slice(1));
const story = stories.find((one) => one.name === chosen) ?? stories[0];
window.addEventListener('hashchange', () => window.location.reload());

applyLook(usePrefs.getState());
await startWords(usePrefs.getState().language);
if (story) {
  window.fetch = network(story.answers);
  if (story.snapshot) useLive.getState().takeSnapshot(snapshot(story.snapshot));
  const root = document.getElementById('root');
  if (!root) throw new Error('the gallery has no element with the id "root"');
  createRoot(root).render(
    <StrictMode>
      <div className={css.gallery}>
        <nav className={css.names}>
          {stories.map(({ name }) => (
            <a key={name} href={`#${encodeURIComponent(name)}`} aria-current={name === story.name}>
              {name}
            </a>
          ))}
        </nav>
        <main className={css.stage}>{story.part()}</main>
      </div>
    </StrictMode>,
  );
}
