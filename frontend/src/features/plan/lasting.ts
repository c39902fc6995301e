/** What somebody is changing: it outlives that its part of the page goes for a while, and goes with the page. */
import { useState } from 'react';
import { create } from 'zustand';

import type { PlanView, StepView } from '@/live/types';

import { asItIs, callsOf, pendingSteps, rebased, toDrafts, type DraftStep } from './editing';

export const useKeptEdits = create<Readonly<Record<string, unknown>>>()(() => ({}));

/** As `useState`, under a name. */
export function useLasting<T>(name: string, initial: T): [T, (value: T) => void] {
  const [first] = useState(initial);
  const kept = useKeptEdits((all) => all[name]);
  return [kept === undefined ? first : (kept as T), (value) => useKeptEdits.setState({ [name]: value })];
}

/** What is kept of the change of a robot's plan: which plan that was, and under what name all else of it. */
export const baseOf = (robot: string) => `${robot} base`;
export const editId = (robot: string, plan: PlanView | null) => `${robot} ${plan?.revision ?? ''}`;

/**
 * Take what was made of steps under one name over into a robot's plan as it is now, to be changed on there.
 * @param opened Whether it is being changed there already, and the keyboard stays where it is.
 * @returns Whether anything of it is left: all may have begun, or be out by now.
 */
export function carryOver(from: string, then: readonly StepView[], plan: PlanView, opened = false): boolean {
  const mine = useKeptEdits.getState()[`${from} steps`] ?? toDrafts(pendingSteps(then));
  const steps = rebased(then, mine as readonly DraftStep[], plan.steps);
  forget(from);
  const id = editId(plan.robot, plan);
  useKeptEdits.setState({ [`${id} steps`]: steps, [`${id} opened`]: opened, [baseOf(plan.robot)]: plan });
  return !asItIs(plan.steps, callsOf(steps));
}

/** Forget all that is kept under a name. */
export function forget(id: string): void {
  const left = Object.entries(useKeptEdits.getState()).filter(([name]) => !name.startsWith(`${id} `));
  useKeptEdits.setState(Object.fromEntries(left), true);
}
