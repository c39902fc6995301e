import { useMemo, useState } from 'react';
import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { decidePlan } from '@/live/api';
import { linesOf } from '@/live/lines';
import { withMission } from '@/live/missions';
import { wishing } from '@/live/questions';
import { useWorld } from '@/live/store';
import type { ChatEntry, ProposalView } from '@/live/types';
import { attempt } from '@/state/do';
import { draftKey, useDrafts } from '@/state/drafts';
import { Button } from '@/ui/button';
import { nameList, sentence } from '@/ui/words';

import css from './asks.module.css';
import { Choices } from './choices';
import { useInSight } from './use-in-sight';

/** What is too long to be seen at once scrolls, for keys as well. */
const byKeys = (text: HTMLElement | null) => {
  if (text) text.tabIndex = text.scrollHeight > text.clientHeight ? 0 : -1;
};

/** As it is understood in every language. */
const NEVER_MIND = 'never mind';

type Choose = (entry: ChatEntry, choice: string) => void;

interface Props {
  chosen: readonly string[];
  /** What was asked in words, newest last. */
  asked: readonly ChatEntry[];
  onChoose: Choose;
}

/** What waits for an answer of the chosen robots, where one writes and always in sight: the newest, the others a tap away. */
export function Asks({ chosen, asked, onChoose }: Props) {
  const { t } = useTranslation('chat');
  const proposals = useWorld((world) => world.proposals);
  const missions = useWorld((world) => world.missions);
  const waiting = useMemo(
    () => {
      const elsewhere = withMission(missions);
      const own = Object.values(proposals).filter((one) => chosen.includes(one.robot) && !elsewhere.has(one.id));
      return [...own, ...asked].toReversed();
    },
    [proposals, missions, chosen, asked],
  );
  const chat = useWorld((world) => world.chat);
  /** The message that says what a proposal is about; of several of one robot it is not known which says which. */
  const saidIn = ({ robot }: ProposalView) => {
    const all = Object.values(proposals).filter((one) => one.robot === robot);
    return all.length === 1 ? ([...wishing(chat, all)][0] ?? '') : '';
  };
  const [back, setBack] = useState(0);
  const at = back % Math.max(1, waiting.length);
  const shown = waiting[at];
  if (!shown) return null;
  const others = waiting.length > 1 && (
    <Button tone="quiet" onPress={() => setBack(at + 1)}>
      {t('moreAsks', { count: waiting.length - 1 })}
    </Button>
  );
  return 'digest' in shown ? (
    <Proposal key={shown.id} proposal={shown} saidIn={saidIn(shown)} chosen={chosen}>
      {others}
    </Proposal>
  ) : (
    <Question key={shown.id} entry={shown} isOneOfMany={chosen.length > 1} onChoose={onChoose}>
      {others}
    </Question>
  );
}

interface QuestionProps {
  entry: ChatEntry;
  /** Whether others are talked to as well: then it has to be said whose question it is. */
  isOneOfMany: boolean;
  onChoose: Choose;
  children: React.ReactNode;
}

function Question({ entry, isOneOfMany, onChoose, children }: QuestionProps) {
  const { t, i18n } = useTranslation('chat');
  const name = nameList(entry.targets, i18n.language);
  const isRead = useInSight(entry.id) && !isOneOfMany;
  return (
    <section className={css.ask} data-comes aria-label={t('questionHere', { name })}>
      <p className={isRead ? 'hidden' : css.wishes} ref={isRead ? null : byKeys}>
        <strong>{t('answering', { name })}</strong> {entry.message}
      </p>
      <div className={css.buttons}>
        <Choices entry={entry} onChoose={onChoose} />
        {/* What a reply asks for may not be wanted any more; a robot that waits for help says itself what can be done. */}
        {entry.type === 'response' && entry.choices.length === 0 && (
          <Button needs="speak" onPress={() => onChoose(entry, NEVER_MIND)}>
            {t('neverMind')}
          </Button>
        )}
        {children}
      </div>
    </section>
  );
}

interface ProposalProps {
  proposal: ProposalView;
  saidIn: string;
  chosen: readonly string[];
  children: React.ReactNode;
}

function Proposal({ proposal, saidIn, chosen, children }: ProposalProps) {
  const { t } = useTranslation(['plan', 'chat']);
  const [busy, setBusy] = useState(false);
  const writing = useDrafts(({ drafts }) => Boolean(drafts[draftKey(chosen)]?.text)); // then sending is what stands out
  const decide = async (decision: 'approve' | 'reject') => {
    setBusy(true);
    await attempt(() => decidePlan(proposal.robot, { id: proposal.id, digest: proposal.digest, decision }));
    setBusy(false);
  };
  const isRead = useInSight(saidIn) && chosen.length === 1;
  const lines = linesOf(proposal.steps);
  const wishes = [...proposal.changes, ...lines.map(({ step }) => sentence(step.label))];
  return (
    <section className={css.ask} data-comes aria-label={t('chat:asksHere', { robot: proposal.robot })}>
      <p className={css.title} data-read={isRead}>
        <Link href="/plan">{t('proposalTitle', { robot: proposal.robot })}</Link>
      </p>
      <p className={isRead ? 'hidden' : css.wishes} ref={isRead ? null : byKeys}>{wishes.join(' · ')}</p>
      <div className={css.buttons}>
        <Button needs="approve" tone={writing ? 'plain' : 'main'} icon="check" isDisabled={busy} onPress={() => void decide('approve')}>
          {t('approve', { count: lines.length, what: sentence(lines[0]?.step.label ?? '') })}
        </Button>
        <Button needs="approve" icon="cross" isDisabled={busy} onPress={() => void decide('reject')}>
          {t('reject')}
        </Button>
        {children}
      </div>
    </section>
  );
}
