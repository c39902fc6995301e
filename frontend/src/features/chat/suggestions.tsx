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
  const labels = useWorld((world) => world.info?.shown_examples ?? NONE);
  const offline = useWorld((world) => world.info?.offline_language ?? true);
  const writing = useDrafts(({ drafts }) => Boolean(drafts[draftKey([robot])]?.text));
  const playing = useTour((tour) => tour.lines.length > 0);
  if (writing || playing || entries.length === 0) return null;
  const own = offline ? i18n.getFixedT('en', 'chat') : t; // what is sent is what the engine understands
  const said = new Set(entries.map((entry) => entry.message));
  const untold = examples.map((say, index) => ({ say, label: labels[index] ?? say })).filter(({ say }) => !said.has(say));
  const fitting: Readonly<Record<string, readonly { say: string; label: string }[]>> = {
    paused: [
      { say: own('say.carryOn'), label: t('say.carryOn') },
      { say: own('say.cancel'), label: t('say.cancel') },
    ],
    running: [{ say: own('say.doing'), label: t('say.doing') }],
    idle: untold.slice(0, SHOWN),
  };
  const shown = fitting[mood] ?? [];
  if (shown.length === 0) return null;
  return (
    <div className={css.bar} role="group" aria-label={t('suggestions')}>
      {shown.map(({ say, label }) => (
        <Button key={say} onPress={() => onSay(say)}>
          {label}
        </Button>
      ))}
    </div>
  );
}
