import { useTranslation } from 'react-i18next';

import type { AbilityView, RobotView } from '@/live/types';
import { draftKey, useDrafts } from '@/state/drafts';
import { useSelectionStore } from '@/state/selection';
import { Button } from '@/ui/button';
import { needsCare } from '@/ui/risk';
import { goTo } from '@/ui/use-hash';
import { inWords, sentence } from '@/ui/words';

import css from './robots.module.css';

const PHRASES_SHOWN = 3;

/** What a robot can do, and how to ask for it. */
export function Abilities({ robot }: { robot: RobotView }) {
  const { t } = useTranslation('robots');
  if (robot.catalogue.length === 0) return <p className={css.quiet}>{t('canUnknown')}</p>;
  return (
    <details className={css.abilities}>
      <summary>{t('can', { name: robot.name, count: robot.catalogue.length })}</summary>
      <ul>
        {robot.catalogue.map((action) => (
          <Ability key={action.name} action={action} robot={robot.name} />
        ))}
      </ul>
    </details>
  );
}

function Ability({ action, robot }: { action: AbilityView; robot: string }) {
  const { t } = useTranslation(['robots', 'plan']);
  const add = useDrafts((state) => state.add);
  const only = useSelectionStore((state) => state.only);
  const phrases = action.phrases.slice(0, PHRASES_SHOWN).map((phrase) => sentence(phrase.replaceAll(/\{\w+\}/g, '…')));
  const say = (phrase: string) => {
    only(robot);
    add(draftKey([robot]), phrase.replace(/\s*…\s*$/, ' '));
    goTo('/');
  };
  return (
    <li>
      <p>
        <strong>{action.description || inWords(action.name)}</strong>
        <span className={needsCare(action.kind) ? css.care : css.kind}>{t(`plan:cares.${action.kind}`)}</span>
      </p>
      {phrases.length > 0 && (
        <p className={css.phrases}>
          <span>{t('say')}</span>
          {phrases.map((phrase) => (
            <Button needs="speak" key={phrase} onPress={() => say(phrase)}>
              {phrase}
            </Button>
          ))}
        </p>
      )}
    </li>
  );
}
