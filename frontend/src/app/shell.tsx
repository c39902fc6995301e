import { useTranslation } from 'react-i18next';

import { FavouritesBox } from '@/features/favourites';
import { BottomBar, ConnectionBanner, ModelNote, Sidebar, TopBar } from '@/features/menu';
import { OpenNote, RoleNote } from '@/features/people';
import { AddRobot } from '@/features/robots';
import { StopBanner } from '@/features/stop';
import { useOverlays } from '@/state/overlays';
import { useStopping } from '@/state/stopping';
import { Boundary } from '@/ui/boundary';
import { Button } from '@/ui/button';
import { StopButton } from '@/ui/stop-button';
import { useIsLow, useLayout } from '@/ui/use-media';
import { useShortcut } from '@/ui/use-shortcut';

import { CommandPalette } from './command-palette';
import { Pages } from './pages';
import css from './shell.module.css';
import { ShortcutSheet } from './shortcut-sheet';
import { Toasts } from './toasts';
import { useEscapeTwice } from './use-escape-twice';
import { useHeard } from './use-heard';
import { useNotices } from './use-notices';
import { useRobotShortcuts } from './use-robot-shortcuts';

interface Props {
  canSignOut: boolean;
  onSessionChanged: () => void;
}

/** What stands around every page: menu, stop button, banners, notes. */
export function Shell(props: Props) {
  const { t } = useTranslation('common');
  const layout = useLayout();
  const isHeld = !useIsLow() && layout === 'phone';
  const open = useOverlays((state) => state.set);
  const stop = useStopping((state) => state.stop);
  useShortcut('mod+k', () => open('commands'));
  useShortcut('?', () => open('shortcuts'));
  useEscapeTwice(() => void stop([]));
  useRobotShortcuts();
  useNotices();
  useHeard();
  const words = { message: t('crashed'), again: t('crashedAgain') };
  return (
    <div className={css.shell} data-layout={layout}>
      <a className={css.skip} href="#content" onClick={focusContent}>
        {t('skipToContent')}
      </a>
      {layout === 'desktop' ? (
        <Sidebar />
      ) : (
        <TopBar hasMenu={!isHeld}>
          <StopButton />
        </TopBar>
      )}
      <div className={css.main}>
        {layout === 'desktop' && (
          <header className={css.bar}>
            <CommandsButton />
            <StopButton />
          </header>
        )}
        <StopBanner />
        <ConnectionBanner />
        <Toasts />
        <section aria-label={t('aboutHere')}>
          <OpenNote />
          <ModelNote />
          <RoleNote />
        </section>
        <main id="content" className={css.content} tabIndex={-1}>
          <Boundary {...words}>
            <Pages {...props} layout={layout} />
          </Boundary>
        </main>
      </div>
      {isHeld && <BottomBar />}
      <CommandPalette />
      <ShortcutSheet />
      <AddRobot />
      <FavouritesBox />
    </div>
  );
}

function CommandsButton() {
  const { t } = useTranslation('menu');
  const open = useOverlays((state) => state.set);
  return (
    <Button icon="search" onPress={() => open('commands')}>
      {t('commandsShort')}
    </Button>
  );
}

function focusContent(event: React.MouseEvent) {
  event.preventDefault(); // the address after # belongs to the pages
  const content = document.getElementById('content');
  (content?.querySelector<HTMLElement>('[data-home]:not(:disabled)') ?? content)?.focus();
}
