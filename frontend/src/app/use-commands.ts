import { useTranslation } from 'react-i18next';
import { useLocation } from 'wouter';

import { offered, pathOf } from '@/features/menu';
import { commandPlan } from '@/live/api';
import { useWorld } from '@/live/store';
import { attempt } from '@/state/do';
import { useMayAll } from '@/state/me';
import { useOverlays } from '@/state/overlays';
import { usePrefs, type Theme } from '@/state/prefs';
import { useRobotNames, useSelectionStore } from '@/state/selection';
import { useStopping } from '@/state/stopping';

export interface Command {
  id: string;
  label: string;
  run: () => void;
}

const themes: readonly Theme[] = ['system', 'light', 'dark', 'contrast'];

/** What can be done now, most urgent first. */
export function useCommands(): Command[] {
  const { t } = useTranslation(['menu', 'stop', 'chat', 'favourites']);
  const may = useMayAll();
  const [, go] = useLocation();
  const names = useRobotNames();
  const info = useWorld((world) => world.info);
  const stop = useStopping((state) => state.stop);
  const only = useSelectionStore((state) => state.only);
  const open = useOverlays((state) => state.set);
  const prefs = usePrefs();
  const perRobot = names.flatMap((name) => [
    { id: `talk ${name}`, label: t('talkTo', { name }), run: () => only(name) },
    { id: `pause ${name}`, label: t('pauseRobot', { name }), run: () => void attempt(() => commandPlan(name, 'pause')) },
    ...(may('resume') ? [{ id: `resume ${name}`, label: t('resumeRobot', { name }), run: () => void attempt(() => commandPlan(name, 'resume')) }] : []),
    ...(names.length > 1 ? [{ id: `stop ${name}`, label: t('stop:stopOnly', { name }), run: () => void stop([name]) }] : []),
  ]);
  return [
    { id: 'stop', label: t('stop:stopAll'), run: () => void stop([]) },
    ...perRobot,
    ...(may('speak') ? [{ id: 'favourites', label: t('favourites:title'), run: () => open('favourites') }] : []),
    ...offered(info, may).map((page) => ({
      id: `go ${page}`,
      label: t('goTo', { page: t(page) }),
      run: () => go(pathOf(page)),
    })),
    ...(may('setting') ? [{ id: 'add', label: t('chat:addRobot'), run: () => open('addRobot') }] : []),
    ...themes.map((theme) => ({
      id: `theme ${theme}`,
      label: t('useTheme', { theme: t(`themes.${theme}`) }),
      run: () => prefs.set({ theme }),
    })),
    { id: 'debug', label: t('debug'), run: () => prefs.set({ debug: !prefs.debug }) },
    { id: 'shortcuts', label: t('shortcuts'), run: () => open('shortcuts') },
  ];
}
