import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { ChatEntry, MapRoom } from '@/live/types';
import { useOutbox } from '@/state/outbox';
import { useRobotNames } from '@/state/selection';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import css from './map.module.css';
import { nameOf, type Candidates, type Mark } from './marks';
import { useSaying } from './use-saying';
import type { Way } from './use-way';
import { roomAt } from './viewport';

interface Props {
  robot: string;
  marked: Mark | null;
  way: Way;
  question: ChatEntry | undefined;
  candidates: Candidates;
  rooms: readonly MapRoom[];
  onClear: () => void;
  /** It is to become a rule. */
  onRule: (marked: Mark) => void;
}

/** What can be done with what is picked out. */
export function PlaceBar({ robot, marked, way, question, candidates, rooms, onClear, onRule }: Props) {
  const { t } = useTranslation('map');
  if (!marked) {
    return (
      <div className={css.bar} data-empty="true" aria-live="polite">
        <p className={css.hint}>{candidates.size > 0 ? t('tapAnswer', { robot }) : t('tap')}</p>
      </div>
    );
  }
  const room = roomAt(rooms, marked.at);
  const titles: Record<Mark['kind'], string> = {
    thing: marked.kind === 'thing' ? nameOf(marked.thing) : '',
    room: marked.kind === 'room' ? marked.room.name : '',
    place: room ? t('placeIn', { room: room.name }) : t('place'),
  };
  const title = sentence(titles[marked.kind]);
  const candidate = marked.kind === 'thing' ? candidates.get(marked.thing.id) : undefined;
  return (
    <div className={css.bar} aria-live="polite">
      <p>
        <strong>{title}</strong> <WayWords robot={robot} way={way} />
      </p>
      {candidate && question ? (
        <Answer question={question} choice={candidate.choice} onDone={onClear} />
      ) : (
        <Deeds robot={robot} marked={marked} way={way} onRule={onRule} />
      )}
      <Button tone="quiet" icon="close" iconOnly aria-label={t('unmark')} onPress={onClear} />
    </div>
  );
}

/** How far it is, or why not. */
function WayWords({ robot, way }: { robot: string; way: Way }) {
  const { t } = useTranslation('map');
  if (way.state === 'none') return <span className={css.no}>{t('noWay', { robot })}</span>;
  if (way.state === 'refused') return <span className={css.no}>{way.why}</span>;
  if (way.state !== 'found') return null;
  return <span className={css.hint}>{t('far', { metres: way.metres.toFixed(1), seconds: Math.ceil(way.seconds) })}</span>;
}

function Deeds({ robot, marked, way, onRule }: Pick<Props, 'robot' | 'way' | 'onRule'> & { marked: Mark }) {
  const { t } = useTranslation('map');
  const say = useSaying(robot);
  const hasRules = useWorld((world) => world.info?.modules?.rules ?? false);
  const several = useRobotNames().length > 1;
  const thing = marked.kind === 'room' ? marked.room.name : marked.kind === 'thing' ? nameOf(marked.thing) : '';
  const go = thing ? t('goTo', { thing }) : t('goThere');
  const isRefused = way.state === 'none' || way.state === 'refused';
  return (
    <>
      {!isRefused && (
        <Button needs="speak" tone="main" icon="chat" isDisabled={way.state === 'asking'} onPress={() => say('go', marked)}>
          {several ? t('named', { robot, deed: go }) : go}
        </Button>
      )}
      <Button needs="speak" onPress={() => say('mention', marked)}>
        {t('mention')}
      </Button>
      {hasRules && marked.kind !== 'place' && (
        <Button needs="rule" onPress={() => onRule(marked)}>
          {t('rule')}
        </Button>
      )}
    </>
  );
}

function Answer({ question, choice, onDone }: { question: ChatEntry; choice: string; onDone: () => void }) {
  const { t } = useTranslation('map');
  const send = useOutbox((outbox) => outbox.send);
  const answer = () => {
    void send({ text: choice, targets: question.targets, reply_to: question.id, images: [] });
    onDone();
  };
  return (
    <Button needs="speak" tone="main" icon="check" onPress={answer}>
      {t('answer', { choice })}
    </Button>
  );
}
