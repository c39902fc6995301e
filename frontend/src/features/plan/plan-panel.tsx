import { useEffect, useMemo, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { PlanView, StepState } from '@/live/types';
import { planKey } from '@/live/world';
import { useSelection } from '@/state/selection';
import { Choice } from '@/ui/choice';
import { Empty, Panel } from '@/ui/panel';

import { pendingSteps, toDraft } from './editing';
import { PlanControls } from './plan-controls';
import { PlanEditor } from './plan-editor';
import { withReceived } from './parameters';
import css from './plan-panel.module.css';
import { PolicyChoice } from '@/ui/policy-choice';
import { ProposalCard } from './proposal-card';
import { pickPlan, proposalsOf, shownPlans } from './shown-plans';
import { StepCard } from './step-card';
import { useRemoving, useSaving } from './use-saving';

const BUSY: readonly StepState[] = ['running', 'waiting', 'failed', 'paused', 'stopping'];

/** What a robot is doing and will do, step by step. */
export function PlanPanel() {
  const { t } = useTranslation(['plan', 'common']);
  const plans = useWorld((world) => world.plans);
  const robots = useWorld((world) => world.robots);
  const chosen = useSelection();
  const [picked, setPicked] = useState({ key: '', whileChosen: '' });
  const shown = shownPlans(plans, robots);
  // A pick holds until the person talks to another robot.
  const plan = pickPlan(shown, picked.whileChosen === chosen.join('\n') ? picked.key : '', chosen);
  const name = (one: PlanView) =>
    one.kind === 'plan' ? t('planOf', { robot: one.robot }) : t('otherTask', { robot: one.robot, name: one.graph_name });
  const choice = plan && (
    <Choice
      label={t('which')}
      hideLabel
      value={planKey(plan)}
      options={shown.map((one) => ({ id: planKey(one), label: name(one) }))}
      onChange={(key) => setPicked({ key, whileChosen: chosen.join('\n') })}
    />
  );
  return (
    <Panel title={t('title')} tools={choice} flush>
      {plan ? <PlanOf key={partKey(plan)} plan={plan} /> : <Empty title={t('noRobot')}>
          <p>{t('noRobotHelp')}</p>
        </Empty>}
    </Panel>
  );
}

/** A robot's own plan stays the same part of the page whichever steps it has, or open boxes would close. */
const partKey = (plan: PlanView) => (plan.kind === 'plan' ? plan.robot : planKey(plan));

function PlanOf({ plan }: { plan: PlanView }) {
  const { t } = useTranslation(['plan', 'common']);
  const proposals = useWorld((world) => world.proposals);
  const here = useWorld((world) => world.robots[plan.robot]?.connection === 'here');
  const [editing, setEditing] = useState<PlanView | null>(null);
  const waiting = plan.kind === 'plan' ? proposalsOf(proposals, plan.robot) : [];
  const current = plan.steps.findIndex((step) => BUSY.includes(step.state));
  const pending = pendingSteps(plan.steps);
  const told = useMemo(() => withReceived(plan.steps), [plan.steps]);
  const close = () => setEditing(null);
  const save = useSaving();
  const remove = useRemoving(plan);
  const steps = useCurrentInView(current, editing !== null);
  return (
    <>
      <div className={css.bar} data-state={plan.state}>
        <p className={css.state}>
          {t(`state.${plan.state}`)}
          {current >= 0 && plan.steps.length > 1 && t('stateStep', { number: current + 1, all: plan.steps.length })}
        </p>
        <HeldBy by={plan.held_by} />
        {!here && <p className={css.away}>{t('away', { robot: plan.robot })}</p>}
        <PlanControls plan={plan} onEdit={pending.length > 0 && !editing ? () => setEditing(plan) : null} />
      </div>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys */}
      <div className={css.scroller} tabIndex={0} role="region" aria-label={t('steps')}>
        {waiting.map((proposal) => (
          <ProposalCard key={proposal.id} proposal={proposal} />
        ))}
        {editing && (
          <PlanEditor
            key={editing.revision}
            robot={plan.robot}
            steps={pendingSteps(editing.steps).map(toDraft)}
            saveLabel={t('common:save')}
            onSave={async (calls) => {
              const outcome = await save(plan.robot, calls, editing.revision);
              if (outcome !== 'refused') close();
            }}
            onCancel={close}
          />
        )}
        {plan.steps.length > 0 && (
          <ol className={css.steps} ref={steps}>
            {told
              .filter((step) => !editing || step.state !== 'queued')
              .map((step, index) => (
                <StepCard
                  key={step.id}
                  step={step}
                  number={index + 1}
                  changed={plan.changed.includes(step.id)}
                  onRemove={plan.kind === 'plan' && step.state === 'queued' ? () => remove(step) : null}
                />
              ))}
          </ol>
        )}
        {plan.steps.length === 0 && waiting.length === 0 && (
          <Empty title={t('empty', { robot: plan.robot })}>
            <p>{t('emptyHelp')}</p>
          </Empty>
        )}
      </div>
      {plan.kind === 'plan' && (
        <footer className={css.foot}>
          <PolicyChoice robot={plan.robot} />
        </footer>
      )}
    </>
  );
}

/** Who told it to stand still. */
function HeldBy({ by }: { by: PlanView['held_by'] }) {
  const { t } = useTranslation('plan');
  return by?.name ? <p>{t('heldBy', { who: by.name })}</p> : null;
}

/** Brings the step that is being done into view when another one's turn has come. */
function useCurrentInView(current: number, busyElsewhere: boolean) {
  const list = useRef<HTMLOListElement>(null);
  useEffect(() => {
    if (current > 0 && !busyElsewhere) list.current?.children[current]?.scrollIntoView({ block: 'nearest' });
  }, [current, busyElsewhere]);
  return list;
}
