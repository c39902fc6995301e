/** Whether orders are understood in another language than the one in which this person reads. */
import { useWorld } from '@/live/store';

import { usePrefs } from './prefs';

export function useForeign(): boolean {
  const offline = useWorld((world) => world.info?.offline_language ?? false);
  return usePrefs(({ language }) => language !== 'en') && offline;
}
