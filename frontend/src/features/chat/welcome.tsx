import { useTranslation } from 'react-i18next';

import { useLive, useWorld } from '@/live/store';
import { useMay } from '@/state/me';
import { useTour } from '@/state/tour';
import { Button } from '@/ui/button';
import { Empty, Loading } from '@/ui/panel';
import { nameList } from '@/ui/words';

import css from './welcome.module.css';

interface Props {
  chosen: readonly string[];
  onSay: (text: string) => void;
}

const NO_EXAMPLES: readonly string[] = [];
const SHOWN = 3;

/** What is there before anything was said: sentences to begin with, one tap each. */
export function Welcome({ chosen, onSay }: Props) {
  const { t, i18n } = useTranslation(['chat', 'common']);
  const examples = useWorld((world) => world.info?.examples ?? NO_EXAMPLES);
  const labels = useWorld((world) => world.info?.shown_examples ?? NO_EXAMPLES);
  const tour = useWorld((world) => world.info?.tour ?? NO_EXAMPLES);
  const begin = useTour((state) => state.begin);
  const known = useLive((live) => live.world.run !== '');
  const maySpeak = useMay('speak');
  if (!known) return <Loading />;
  if (chosen.length === 0) {
    return (
      <Empty title={t('emptyNobody')}>
        <p>{t('emptyNobodyText')}</p>
      </Empty>
    );
  }
  if (!maySpeak) return <Empty title={t('emptyViewer')} />;
  return (
    <Empty title={t('emptyTitle', { name: nameList(chosen, i18n.language) })}>
      <p>{t('emptyText')}</p>
      <ul className={css.examples}>
        {examples.slice(0, SHOWN).map((example, index) => (
          <li key={example}>
            <Button onPress={() => onSay(example)}>{labels[index] ?? example}</Button>
          </li>
        ))}
      </ul>
      {tour.length > 0 && chosen.length === 1 && (
        <>
          <Button icon="play" onPress={() => begin(tour)}>
            {t('showMe')}
          </Button>
          <p>{t('showMeText')}</p>
        </>
      )}
    </Empty>
  );
}
