import { useTranslation } from 'react-i18next';

import { inWords } from '@/ui/words';

const known = ['camera', 'map', 'inspection'] as const;

/** What people call a feed. */
export function useFeedName(name: string): string {
  const { t } = useTranslation('display');
  const found = known.find((one) => one === name);
  return found ? t(`names.${found}`) : inWords(name);
}
