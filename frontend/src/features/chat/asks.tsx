import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { decidePlan } from '@/live/api';
import { linesOf } from '@/live/lines';
import { useWorld } from '@/live/store';
import type { ProposalView } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { sentence } from '@/ui/words';

import css from './asks.module.css';

/** What waits for a yes of the chosen robots, where the talk is; always in sight. */
export function Asks({ chosen }: { chosen: readonly string[] }) {
  const proposals = useWorld((world) => world.proposals);
  const waiting = Object.values(proposals).filter((proposal) => chosen.includes(proposal.robot));
  const newest = waiting.at(-1);
  return newest ? <Ask key={newest.id} proposal={newest} more={waiting.length - 1} /> : null;
}

function Ask({ proposal, more }: { proposal: ProposalView; more: number }) {
  const { t } = useTranslation(['plan', 'chat']);
  const [busy, setBusy] = useState(false);
  const decide = async (decision: 'approve' | 'reject') => {
    setBusy(true);
    await attempt(() => decidePlan(proposal.robot, { id: proposal.id, digest: proposal.digest, decision }));
    setBusy(false);
  };
  const title = t('proposalTitle', { robot: proposal.robot });
  const wishes = [...proposal.changes, ...linesOf(proposal.steps).map(({ step }) => sentence(step.label))];
  return (
    <section className={css.ask} aria-label={t('chat:asksHere', { robot: proposal.robot })}>
      <p className={css.title}>{title}</p>
      <p className={css.wishes}>{wishes.join(' · ')}</p>
      <div className={css.buttons}>
        <Button needs="approve" icon="check" isDisabled={busy} onPress={() => void decide('approve')}>
          {t('approve')}
        </Button>
        <Button needs="approve" icon="cross" isDisabled={busy} onPress={() => void decide('reject')}>
          {t('reject')}
        </Button>
        {more > 0 && <span className={css.more}>{t('chat:moreAsks', { count: more })}</span>}
      </div>
    </section>
  );
}
