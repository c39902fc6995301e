import { useEffect, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { ApiError, tryRules, type Trial } from '@/live/api';
import { OVER } from '@/live/lines';
import { useWorld } from '@/live/store';
import type { RuleVerdict, StepView } from '@/live/types';

import { nameOf, type Mark } from './marks';

/** `unsure`: nobody could say; `none`: no way leads there; `refused`: a rule forbids it, in words. */
export type Way =
  | { state: 'idle' | 'asking' | 'unsure' | 'none' }
  | { state: 'refused'; why: string }
  | { state: 'found'; points: Points; goals: Points; metres: number; seconds: number };
type Points = readonly (readonly [number, number])[];

const IDLE: Way = { state: 'idle' };

/** The way a robot would take, without driving it. `trial` null: none is wanted. */
function useTrial(robot: string, trial: Trial | null): Way {
  const { i18n } = useTranslation();
  const known = useWorld((world) => world.info?.modules?.rules ?? false);
  const asked = known && trial ? JSON.stringify(trial) : '';
  const key = `${robot} ${asked}`;
  const [found, setFound] = useState<{ key: string; way: Way }>({ key: '', way: IDLE });
  const { language } = i18n;
  useEffect(() => {
    if (!asked) return undefined;
    let current = true;
    tryRules(robot, JSON.parse(asked) as Trial, language).then(
      (verdict) => current && setFound({ key, way: wayOf(verdict) }),
      (error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        if (current) setFound({ key, way: { state: 'unsure' } });
      },
    );
    return () => {
      current = false;
    };
  }, [robot, asked, key, language]);
  if (!asked) return IDLE;
  return found.key === key ? found.way : { state: 'asking' };
}

function wayOf({ forbidden = [], unknown = [], way = [], goals = [], length_m = 0, expected_s = 0 }: RuleVerdict): Way {
  const why = forbidden.map((finding) => finding.text).join(' ');
  if (why) return { state: 'refused', why };
  if (unknown.length > 0) return { state: 'unsure' };
  return length_m > 0 ? { state: 'found', points: way, goals, metres: length_m, seconds: expected_s } : { state: 'none' };
}

/** The way to what is picked out. */
export function useWayTo(robot: string, marked: Mark | null): Way {
  const trials: Record<Mark['kind'], (mark: Mark) => Trial | null> = {
    place: ({ at }) => ({ goal: [at.x, at.y] }),
    thing: (mark) => (mark.kind === 'thing' ? { words: [nameOf(mark.thing)] } : null),
    room: (mark) => (mark.kind === 'room' ? { words: [mark.room.name] } : null),
  };
  return useTrial(robot, marked && trials[marked.kind](marked));
}

/** The way that a robot proposes and waits for a yes to: from where it is, or where what it does and what was proposed before that ends. */
export function useProposedWay(robot: string): Way {
  const plans = useWorld((world) => world.plans);
  const proposals = useWorld((world) => world.proposals);
  const [steps, ...before] = Object.values(proposals).filter((one) => one.robot === robot).map((one) => one.steps).toReversed();
  const goesOn = Object.values(plans).filter((plan) => plan.robot === robot && plan.steps.some(({ state }) => !OVER.has(state)));
  // What is found out already says where the steps behind it lead.
  const ahead = goesOn.flatMap((plan) => plan.steps.filter(({ state }) => state !== 'skipped'));
  const after = callsOf([...ahead, ...before.toReversed().flat()]);
  return useTrial(robot, steps && steps.length > 0 ? { steps: callsOf(steps), after } : null);
}

const callsOf = (steps: readonly StepView[]) => steps.map((step) => step.call ?? {});
