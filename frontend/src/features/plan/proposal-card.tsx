import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { decidePlan, type Decision } from '@/live/api';
import { useLive } from '@/live/store';
import type { ProposalView } from '@/live/types';
import { attempt } from '@/state/do';
import { useToasts } from '@/state/toasts';
import { Button } from '@/ui/button';
import { quoted, sentence } from '@/ui/words';

import { pendingSteps, toDrafts } from './editing';
import { linesOf } from '@/live/lines';
import { carryOver, useLasting } from './lasting';
import { PlanEditor } from './plan-editor';
import css from './proposal-card.module.css';
import { StepCard } from './step-card';
import { heard, ownPlan } from './use-saving';

/** Steps that wait for a yes. */
export function ProposalCard({ proposal }: { proposal: ProposalView }) {
  const { t } = useTranslation('plan');
  // What is being changed is what was shown then: should it become something else, it is shown anew and asked again.
  const [edited, setEdited] = useLasting<ProposalView | null>(`${proposal.id} shown`, null);
  const ownRef = useNoticeWhenGone(proposal.id, edited);
  const [busy, setBusy] = useState(false);
  const decide = async (decision: Omit<Decision, 'id' | 'digest'>) => {
    setBusy(true);
    ownRef.current = true;
    const { id, digest } = edited ?? proposal;
    ownRef.current = await attempt(() => decidePlan(proposal.robot, { id, digest, ...decision }));
    setBusy(false);
    return ownRef.current;
  };
  const lines = linesOf(proposal.steps);
  const title = t('proposalTitle', { robot: proposal.robot });
  return (
    <section className={css.card} aria-label={title}>
      <h4>{title}</h4>
      {proposal.why && <p className={css.why}>{proposal.why}</p>}
      {edited ? (
        <PlanEditor
          id={proposal.id}
          robot={proposal.robot}
          steps={toDrafts(edited.steps)}
          saveLabel={t('approveChanged')}
          onSave={(steps) => decide({ decision: 'edit', steps })}
          onCancel={() => setEdited(null)}
        />
      ) : (
        <>
          <div className={css.buttons}>
            <Button needs="approve" tone="main" icon="check" isDisabled={busy} onPress={() => void decide({ decision: 'approve' })}>
              {t('approve', { count: lines.length, what: sentence(lines[0]?.step.label ?? '') })}
            </Button>
            <Button needs="approve" icon="edit" isDisabled={busy} onPress={() => setEdited(proposal)}>
              {t('change')}
            </Button>
            <Button needs="approve" icon="cross" isDisabled={busy} onPress={() => void decide({ decision: 'reject' })}>
              {t('reject')}
            </Button>
          </div>
          {proposal.changes.length > 0 && (
            <>
              <h5>{t('changesFirst')}</h5>
              <ul className={css.changes}>
                {proposal.changes.map((change, index) => (
                  <li key={`${index} ${change}`}>{change}</li>
                ))}
              </ul>
            </>
          )}
          <ol className={css.steps}>
            {lines.map((line, index) => (
              <StepCard key={line.step.id} line={line} number={index + 1} changed={false} />
            ))}
          </ol>
          {proposal.message && <p className={css.says}>{t('says', { words: quoted(proposal.message) })}</p>}
        </>
      )}
    </section>
  );
}

/** Says so where somebody else decides about what is being changed here; true while it is decided here. */
function useNoticeWhenGone(id: string, edited: ProposalView | null) {
  const { t } = useTranslation('plan');
  const ownRef = useRef(false);
  useEffect(() => {
    if (!edited) return;
    const show = useToasts.getState().show;
    const decided = async () => {
      await heard(() => begunOf(edited) !== undefined);
      const plan = begunOf(edited);
      const isLeft = plan && carryOver(id, edited.steps, plan);
      const kept = isLeft ? 'conflictKept' : 'conflictPast';
      show({ tone: 'error', message: t(plan ? kept : 'decidedMeanwhile'), stands: 'deed' });
    };
    return useLive.subscribe(({ world }, before) => {
      if (!ownRef.current && !(id in world.proposals) && id in before.world.proposals) void decided();
    });
  }, [id, edited, t]);
  return ownRef;
}

/** The plan that has become of what was proposed, while something of it waits its turn. */
function begunOf({ robot, steps }: ProposalView) {
  const plan = ownPlan(robot);
  const labels = steps.map((step) => step.label);
  return plan && pendingSteps(plan.steps).some((step) => labels.includes(step.label)) ? plan : undefined;
}
