import { useCallback, useMemo, useRef, useState } from 'react';
import { ToggleButton } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { ChatEntry } from '@/live/types';
import { useAsked, useOpenQuestions } from '@/state/asked';
import { draftKey, useDrafts } from '@/state/drafts';
import { useMoment } from '@/state/moment';
import { usePrefs } from '@/state/prefs';
import { useSelection, useSelectionStore } from '@/state/selection';
import { MissionCard } from '@/ui/mission-card';
import { goesOn, isOf } from '@/live/missions';
import { Icon, type IconName } from '@/ui/icon';
import { Panel } from '@/ui/panel';
import { useLayout } from '@/ui/use-media';
import { useShortcut } from '@/ui/use-shortcut';

import { Asks } from './asks';
import css from './chat-panel.module.css';
import { useMay } from '@/state/me';
import { Composer } from './composer';
import { History } from './history';
import { useOutbox } from '@/state/outbox';
import { answering, conversation } from '@/live/questions';
import { RobotTabs } from './robot-tabs';
import { SearchBox } from './search-box';
import { Suggestions } from './suggestions';
import { Tour } from './tour';
import { Welcome } from './welcome';

/** Talking to robots. */
export function ChatPanel() {
  const maySpeak = useMay('speak');
  const { t } = useTranslation('chat');
  const chat = useWorld((world) => world.chat);
  const chosen = useSelection();
  const missions = useWorld((world) => world.missions);
  const phone = useLayout() === 'phone';
  const send = useOutbox((outbox) => outbox.send);
  const { debug, set } = usePrefs();
  const only = useSelectionStore((state) => state.only);
  const showMoment = useMoment((state) => state.show);
  const [searching, setSearching] = useState(false);
  const input = useRef<HTMLTextAreaElement>(null);

  const questions = useOpenQuestions();
  const entries = useMemo(() => conversation(chat, chosen), [chat, chosen]);
  const asked = useAsked();
  const askedHere = useMemo(() => conversation(asked, chosen), [asked, chosen]);
  const answer = useMemo(() => answering(questions, chosen), [questions, chosen]);
  const onItsWay = useOutbox(
    (outbox) => outbox.messages.findLast((one) => one.targets.some((name) => chosen.includes(name)))?.text,
  );
  const lastSaid = useMemo(
    () => onItsWay ?? entries.findLast((entry) => entry.who === 'operator')?.message ?? '',
    [onItsWay, entries],
  );

  const alone = chosen.length === 1 ? chosen[0] : undefined;
  const say = (text: string) => void send({ text, targets: chosen, reply_to: '', images: [] });
  const choose = useCallback(
    (question: ChatEntry, choice: string) =>
      void send({ text: choice, targets: question.targets, reply_to: question.id, images: [] }),
    [send],
  );
  // What was found may have been said to robots that are not spoken to now.
  const goToEntry = (entry: ChatEntry) => {
    if (!conversation([entry], chosen).length && entry.targets[0]) only(entry.targets[0]);
    showMoment(entry.unix_ms);
  };
  const key = draftKey(chosen);
  const edit = useCallback(
    (text: string) => {
      useDrafts.getState().set(key, { text });
      input.current?.focus();
    },
    [key],
  );

  const closeSearch = () => {
    setSearching(false);
    input.current?.focus();
  };

  useShortcut('/', () => input.current?.focus());
  useShortcut('mod+f', () => setSearching(true));

  const find = <Switch icon="search" label={t('search')} isSelected={searching} onChange={setSearching} />;
  const tools = (
    <>
      {find}
      <Switch icon="clock" label={t('debug')} isSelected={debug} onChange={(value) => set({ debug: value })} />
    </>
  );
  return (
    <Panel title={t('title')} tools={tools} flush bare={phone}>
      <div className={css.both}>
        <div className={css.talk}>
          <RobotTabs asked={asked} tools={phone ? find : null} />
          {searching && <SearchBox onGo={goToEntry} onClose={closeSearch} />}
          <History
            key={key}
            entries={entries}
            asked={askedHere}
            onChoose={choose}
            onEdit={edit}
            empty={<Welcome chosen={chosen} onSay={say} />}
          />
        </div>
        <div className={css.speak}>
          {missions
            .filter((mission) => goesOn(mission) && isOf(mission, chosen))
            .map((mission) => {
              const asks = mission.parts.some((part) => part.state === 'asked');
              return (
                <div key={mission.id} className={css.mission} data-yields={phone && !asks}>
                  <MissionCard mission={mission} isFolded={phone || !asks} />
                </div>
              );
            })}
          <Asks chosen={chosen} asked={askedHere} onChoose={choose} />
          {maySpeak && alone && <Tour robot={alone} asks={askedHere.length > 0} />}
          {maySpeak && <Composer chosen={chosen} answering={answer} lastSaid={lastSaid} input={input} />}
          {maySpeak && alone && askedHere.length === 0 && <Suggestions robot={alone} entries={entries} onSay={say} />}
        </div>
      </div>
    </Panel>
  );
}

interface SwitchProps {
  icon: IconName;
  label: string;
  isSelected: boolean;
  onChange: (value: boolean) => void;
}

function Switch({ icon, label, isSelected, onChange }: SwitchProps) {
  return (
    <ToggleButton className={css.switch ?? ''} aria-label={label} isSelected={isSelected} onChange={onChange}>
      <Icon name={icon} />
    </ToggleButton>
  );
}
