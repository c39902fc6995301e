import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { ChatEntry } from '@/live/types';
import { draftKey, useDrafts } from '@/state/drafts';
import { useMood } from '@/state/mood';
import { useTour } from '@/state/tour';
import { Button } from '@/ui/button';

import css from './moment.module.css';

const NONE: readonly string[] = [];
const SHOWN = 2;

interface Props {
  robot: string;
  entries: readonly ChatEntry[];
  onSay: (text: string) => void;
}

/** What one may want to say now, one tap each; nothing while somebody writes. */
export function Suggestions({ robot, entries, onSay }: Props) {
  const { t, i18n } = useTranslation('chat');
  const mood = useMood(robot);
  const examples = useWorld((world) => world.info?.examples ?? NONE);
  const offline = useWorld((world) => world.info?.offline_language ?? true);
  const writing = useDrafts(({ drafts }) => Boolean(drafts[draftKey([robot])]?.text));
  const playing = useTour((tour) => tour.lines.length > 0);
  if (writing || playing || entries.length === 0) return null;
  const own = offline ? i18n.getFixedT('en', 'chat') : t; // what is sent is what the engine understands
  const said = new Set(entries.map((entry) => entry.message));
  const fitting = {
    paused: [own('say.carryOn'), own('say.cancel')],
    running: [own('say.doing')],
    idle: examples.filter((example) => !said.has(example)).slice(0, SHOWN),
  };
  const shown = mood in fitting ? fitting[mood as keyof typeof fitting] : NONE;
  if (shown.length === 0) return null;
  return (
    <div className={css.bar} role="group" aria-label={t('suggestions')}>
      {shown.map((text) => (
        <Button key={text} onPress={() => onSay(text)}>
          {text}
        </Button>
      ))}
    </div>
  );
}
