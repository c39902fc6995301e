import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { ChatEntry } from '@/live/types';
import { useRobotNames, useSelection, useSelectionStore } from '@/state/selection';
import { useMood } from '@/state/mood';
import { Dot } from '@/ui/dot';

import { RobotLine } from './robot-line';
import css from './robot-tabs.module.css';
import { useLongPress } from './use-long-press';

interface TabProps {
  name: string;
  chosen: boolean;
  awaitsAnswer: boolean;
  /** Whether of all of them it is to be in sight. */
  leads: boolean;
  onOnly: () => void;
  onToggle: () => void;
}

function Tab({ name, chosen, awaitsAnswer, leads, onOnly, onToggle }: TabProps) {
  const { t } = useTranslation(['chat', 'robots']);
  const mood = useMood(name);
  const press = useLongPress(onToggle);
  const tab = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    // With many robots on a phone it may be out of sight.
    if (leads) tab.current?.scrollIntoView({ block: 'nearest', inline: 'nearest' });
  }, [leads]);
  return (
    <button
      ref={tab}
      type="button"
      className={css.tab}
      aria-pressed={chosen}
      data-asks={awaitsAnswer}
      title={t(`robots:state.${mood}`)}
      {...press.handlers}
      onClick={(event) => {
        if (press.wasLong()) return;
        if (event.shiftKey || event.ctrlKey || event.metaKey) onToggle();
        else onOnly();
      }}
    >
      {awaitsAnswer ? (
        <span className={css.asks} aria-hidden="true">
          ?
        </span>
      ) : (
        <Dot mood={mood} />
      )}
      <span>{name}</span>{' '}
      <span className="hidden">{awaitsAnswer ? t('awaitsAnswer', { name }) : t(`robots:state.${mood}`)}</span>
    </button>
  );
}

/** The robots one can talk to, and how the chosen ones fare: tap for one; shift-click, long touch or the switch for several. */
export function RobotTabs({ asked, tools = null }: { asked: readonly ChatEntry[]; tools?: React.ReactNode }) {
  const { t } = useTranslation('chat');
  const names = useRobotNames();
  const chosen = useSelection();
  const { only, toggle } = useSelectionStore();
  const proposals = useWorld((world) => world.proposals);
  const asking = new Set([...Object.values(proposals).map((one) => one.robot), ...asked.flatMap((one) => one.targets)]);
  const leading = chosen.find((name) => asking.has(name)) ?? names.find((name) => asking.has(name)) ?? chosen[0];
  const [several, setSeveral] = useState(false);
  const alone = names.length === 1;
  return (
    <>
      <div className={css.row}>
        {alone ? (
          <RobotLine name={names[0] ?? ''} named />
        ) : (
          <div className={css.tabs} role="group" aria-label={t('robots')}>
            {names.map((name) => (
              <Tab
                key={name}
                name={name}
                chosen={chosen.includes(name)}
                awaitsAnswer={asking.has(name)}
                leads={name === leading}
                onOnly={() => (several ? toggle(name, names) : only(name))}
                onToggle={() => toggle(name, names)}
              />
            ))}
          </div>
        )}
        {names.length > 1 && (
          <button
            type="button"
            className={css.several}
            aria-pressed={several}
            title={t('severalHelp')}
            onClick={() => setSeveral(!several)}
          >
            {t('several')}
          </button>
        )}
        {tools}
      </div>
      {!alone && chosen.length > 0 && (
        <div className={css.lines}>
          {chosen.map((name) => (
            <RobotLine key={name} name={name} named={chosen.length > 1} />
          ))}
        </div>
      )}
    </>
  );
}
