import { draftKey, useDrafts } from '@/state/drafts';
import { useSelectionStore } from '@/state/selection';
import { goTo } from '@/ui/use-hash';

/** Takes an order of then up again: its words stand where one writes, to be changed and sent. */
export function sayAgain(robot: string, words: string): void {
  if (robot) useSelectionStore.getState().only(robot);
  useDrafts.getState().add(draftKey(robot ? [robot] : []), words);
  goTo('/');
}
