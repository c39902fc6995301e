import { useContext, useEffect, useMemo, useRef, useState, type Ref } from 'react';
import { useTranslation } from 'react-i18next';

import { putSteps } from '@/live/api';
import { useWorld } from '@/live/store';
import type { ActionCall, PlanView, ProposalView, StepState } from '@/live/types';
import { planKey } from '@/live/world';
import { useSelection } from '@/state/selection';
import { Beside } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { Icon } from '@/ui/icon';
import { Empty, Loading, Panel } from '@/ui/panel';
import { useSame, useStable } from '@/ui/stable';

import { asItIs, pendingSteps, sinceThen, toDrafts } from './editing';
import { MissionCard } from '@/ui/mission-card';
import { goesOn, isOf } from '@/live/missions';
import { Over, PlanBar } from './plan-bar';
import { PlanEditor } from './plan-editor';
import { isEarlier, linesOf, type Line } from '@/live/lines';
import { baseOf, editId, useLasting } from './lasting';
import { withReceived } from './parameters';
import css from './plan-panel.module.css';
import { PolicyChoice } from '@/ui/policy-choice';
import { UnattendedChoice } from '@/ui/unattended-choice';
import { ProposalCard } from './proposal-card';
import { pickPlan, proposalsOf, shownPlans } from './shown-plans';
import { StepCard } from './step-card';
import { useKeptInPlan, usePassed, useRemoving, useSaving } from './use-saving';

const BUSY: readonly StepState[] = ['running', 'waiting', 'failed', 'paused', 'stopping'];

/** What a robot is doing and will do, step by step. */
export function PlanPanel() {
  const { t } = useTranslation(['plan', 'common']);
  const plans = useWorld((world) => world.plans);
  const robots = useWorld((world) => world.robots);
  const known = useWorld((world) => world.run !== '');
  const chosen = useSelection();
  const [picked, setPicked] = useState({ key: '', whileChosen: '' });
  const isBeside = useContext(Beside); // then the conversation says whose
  const shown = shownPlans(plans, robots).filter((plan) => !isBeside || chosen.includes(plan.robot));
  // A pick holds until the person talks to another robot.
  const plan = pickPlan(shown, picked.whileChosen === chosen.join('\n') ? picked.key : '', chosen);
  const name = (one: PlanView) =>
    one.kind === 'plan' ? t('planOf', { robot: one.robot }) : t('otherTask', { robot: one.robot, name: one.graph_name });
  const choice = plan && shown.length > 1 && (
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
      {plan && <PlanOf key={partKey(plan)} plan={plan} />}
      {!plan && !known && <Loading />}
      {!plan && known && (
        <Empty title={t('noRobot')}>
          <p>{t('noRobotHelp')}</p>
        </Empty>
      )}
    </Panel>
  );
}

/** A robot's own plan stays the same part of the page whichever steps it has, or open boxes would close. */
const partKey = (plan: PlanView) => (plan.kind === 'plan' ? plan.robot : planKey(plan));

function PlanOf({ plan }: { plan: PlanView }) {
  const { t } = useTranslation(['plan', 'common']);
  const proposals = useWorld((world) => world.proposals);
  const [editing, setEditing] = useLasting<PlanView | null>(baseOf(partKey(plan)), null);
  const waiting = plan.kind === 'plan' ? proposalsOf(proposals, plan.robot) : [];
  const pending = pendingSteps(plan.steps);
  const { lines, current, over } = useMemo(() => divided(plan), [plan]);
  const since = useMemo(() => sinceThen(editing?.steps ?? [], plan.steps), [editing, plan]);
  const { again, isSame } = since;
  const begun = useSame(since.begun);
  const changed = editing ? pending.filter((step) => !again.includes(step)).map((step) => step.id) : [];
  const id = editId(partKey(plan), editing);
  const [saving, setSaving] = useState(false);
  useKeptInPlan(id, saving ? null : editing, plan, isSame); // what one saves oneself, nobody else has changed
  const close = useStable(() => setEditing(null));
  const save = useSaving();
  const passed = usePassed();
  const first = useMemo(() => toDrafts(pendingSteps(editing?.steps ?? [])), [editing]);
  const saveAll = useStable(async (calls: readonly ActionCall[]) => {
    const all = [...again.map((step) => step.call ?? {}), ...calls];
    const revision = editing && !isSame ? editing.revision : plan.revision;
    setSaving(true);
    const outcome = await save(plan.robot, () => putSteps(plan.robot, all, revision), asItIs(plan.steps, all) ? '' : undefined, null);
    const isDone = outcome === 'saved' || (outcome === 'conflict' && (await passed(plan.robot, revision)));
    if (isDone) close();
    setSaving(false);
    return isDone;
  });
  const remove = useRemoving(plan);
  const steps = useCurrentInView(current - over, editing !== null);
  return (
    <>
      <PlanBar plan={plan} lines={lines} current={current} onEdit={pending.length > 0 && !editing ? () => setEditing(plan) : null} />
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- what scrolls must be reachable by keys */}
      <div className={css.scroller} tabIndex={0} role="region" aria-label={t('steps')}>
        <Together robot={plan.robot} open={lines.length - over + waiting.length} />
        <Steps title={t('earlier')} from={0} lines={lines.slice(0, over)} plan={plan} isFolded={over < lines.length || waiting.length > 0} />
        <Steps title={t('now')} from={over} lines={lines.slice(over)} plan={plan} isChanged={(id) => changed.includes(id)} onRemove={editing ? undefined : remove} list={steps} />
        <Over plan={plan} isEdited={editing !== null} waiting={waiting.length} />
        {editing && (
          <PlanEditor
            id={id}
            robot={plan.robot}
            steps={first}
            before={lines.filter(({ step }) => !changed.includes(step.id)).length}
            begun={begun}
            saveLabel={t('common:save')}
            onSave={saveAll}
            onCancel={close}
          />
        )}
        <Proposed waiting={waiting} />
      </div>
      {!editing && <Foot plan={plan} />}
    </>
  );
}

/** What the robot does with others: all that goes on, or else what ended last, until it does something else. */
function Together({ robot, open }: { robot: string; open: number }) {
  const isBeside = useContext(Beside); // then the conversation shows what goes on
  const missions = useWorld((world) => world.missions);
  const own = missions.filter((mission) => isOf(mission, [robot]));
  const going = own.filter(goesOn);
  if (isBeside && going.length > 0) return null;
  return (going.length > 0 || open > 0 ? going : own.slice(-1)).map((mission) => (
    <MissionCard key={mission.id} mission={mission} isFolded={!goesOn(mission)} />
  ));
}

/** What holds for tasks to come. */
function Foot({ plan }: { plan: PlanView }) {
  if (plan.kind !== 'plan') return null;
  return (
    <footer className={css.foot}>
      <PolicyChoice robot={plan.robot} />
      <UnattendedChoice />
    </footer>
  );
}

/** The steps as lines, which of them is being done, and how many are over. */
function divided(plan: PlanView) {
  const lines = linesOf(withReceived(plan.steps));
  const current = lines.findIndex(({ step }) => BUSY.includes(step.state));
  const open = plan.state === 'ended' ? -1 : lines.findIndex((line) => !isEarlier(line));
  return { lines, current, over: open < 0 ? lines.length : open };
}

/** What waits for a yes; it comes last, as it would be done last. */
function Proposed({ waiting }: { waiting: readonly ProposalView[] }) {
  const { t } = useTranslation('plan');
  if (waiting.length === 0) return null;
  return (
    <section className={css.part}>
      <h3 className={css.heading}>{t('proposed')}</h3>
      {waiting.map((proposal) => (
        <ProposalCard key={proposal.id} proposal={proposal} />
      ))}
    </section>
  );
}

interface StepsProps {
  title: string;
  /** How many stand before them. */
  from: number;
  lines: readonly Line[];
  plan: PlanView;
  /** Whether only their number is shown until somebody wants to see them. */
  isFolded?: boolean;
  /** Whether it is shown where it is changed instead. */
  isChanged?: (id: string) => boolean;
  onRemove?: ((line: Line) => void) | undefined;
  list?: Ref<HTMLOListElement>;
}

/** Steps under a heading, in the order in which they are done. */
function Steps({ title, from, lines, plan, isFolded = false, isChanged = () => false, onRemove, list }: StepsProps) {
  const { t } = useTranslation('plan');
  const [open, setOpen] = useState(false);
  if (lines.length === 0) return null;
  return (
    <section className={css.part}>
      <h3 className={css.heading}>
        {title}
        {isFolded && (
          <button type="button" className={css.fold} aria-expanded={open} onClick={() => setOpen(!open)}>
            {t('stepCount', { count: lines.length })}
            <Icon name={open ? 'up' : 'down'} size={16} />
          </button>
        )}
      </h3>
      {(open || !isFolded) && (
        <ol className={css.steps} ref={list} start={from + 1}>
          {lines.map((line, index) =>
            isChanged(line.step.id) ? null : (
              <StepCard
                key={line.step.id}
                line={line}
                number={from + index + 1}
                changed={plan.changed.includes(line.step.id)}
                isHeld={plan.state === 'held'}
                onRemove={onRemove && plan.kind === 'plan' && line.step.state === 'queued' ? () => onRemove(line) : null}
              />
            ),
          )}
        </ol>
      )}
    </section>
  );
}

/** Brings the step that is being done into view when another one's turn has come. */
function useCurrentInView(current: number, busyElsewhere: boolean) {
  const list = useRef<HTMLOListElement>(null);
  useEffect(() => {
    if (current >= 0 && !busyElsewhere) list.current?.children[current]?.scrollIntoView({ block: 'nearest' });
  }, [current, busyElsewhere]);
  return list;
}
