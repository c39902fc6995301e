import i18next from 'i18next';
import { useCallback } from 'react';

import { useLive } from '@/live/store';
import { draftKey, useDrafts } from '@/state/drafts';
import { useOutbox } from '@/state/outbox';
import { useSelectionStore } from '@/state/selection';
import { goTo } from '@/ui/use-hash';

import { nameOf, type Mark } from './marks';

/** How exactly a place on the map is named: a centimetre. */
const DIGITS = 2;

/** Says to a robot, as this person and in the chat, to go to what is picked out; or puts its name into what is being written. */
export function useSaying(robot: string) {
  return useCallback(
    (deed: 'go' | 'mention', what: Mark) => {
      const { chosen, only } = useSelectionStore.getState();
      if (!chosen.includes(robot)) only(robot);
      if (deed === 'go') void useOutbox.getState().send({ text: inWords(deed, what), targets: [robot], reply_to: '', images: [] });
      else useDrafts.getState().add(draftKey(chosen.includes(robot) ? chosen : [robot]), inWords(deed, what));
      goTo('/');
    },
    [robot],
  );
}

function inWords(deed: 'go' | 'mention', what: Mark): string {
  // The built-in language engine reads English only, whatever the page is written in.
  const offline = useLive.getState().world.info?.offline_language ?? true;
  const t = i18next.getFixedT(offline ? 'en' : i18next.language, 'map');
  if (what.kind === 'place') {
    return t(deed === 'go' ? 'sayGoPlace' : 'sayPlace', { x: what.at.x.toFixed(DIGITS), y: what.at.y.toFixed(DIGITS) });
  }
  return t(deed === 'go' ? 'sayGo' : 'sayThing', { thing: what.kind === 'room' ? what.room.name : nameOf(what.thing) });
}
