import i18next from 'i18next';
import { useCallback } from 'react';

import { useLive } from '@/live/store';
import type { MapThing } from '@/live/types';
import { draftKey, useDrafts } from '@/state/drafts';
import { effective, useRobotNames, useSelectionStore } from '@/state/selection';
import { goTo } from '@/ui/use-hash';

import type { Place } from './viewport';

/** How exactly a place on the map is named: a centimetre. */
const DIGITS = 2;

/** Puts what is picked out on the map into words, in the chat, for the person to send or change. */
export function useSaying() {
  const names = useRobotNames();
  const add = useDrafts((state) => state.add);
  return useCallback(
    (deed: 'go' | 'mention', what: Place | MapThing) => {
      const chosen = effective(useSelectionStore.getState().chosen, names);
      add(draftKey(chosen), inWords(deed, what));
      goTo('/');
    },
    [names, add],
  );
}

function inWords(deed: 'go' | 'mention', what: Place | MapThing): string {
  // The built-in language engine reads English only, whatever the page is written in.
  const offline = useLive.getState().world.info?.offline_language ?? true;
  const t = i18next.getFixedT(offline ? 'en' : i18next.language, 'map');
  if ('id' in what) return t(deed === 'go' ? 'sayGo' : 'sayThing', { thing: what.description || what.kind });
  return t(deed === 'go' ? 'sayGoPlace' : 'sayPlace', { x: what.x.toFixed(DIGITS), y: what.y.toFixed(DIGITS) });
}
