import { describe, expect, it } from 'vitest';

import { plan, robot } from '@/live/samples';
import { planKey } from '@/live/world';

import { pickPlan, shownPlans } from './shown-plans';

const plans = {
  one: plan({ robot: 'Bob', graph_name: 'patrol', kind: 'graph' }),
  two: plan({ robot: 'Bob', graph_name: 'plan_7' }),
};
const robots = { Ada: robot({ name: 'Ada' }), Bob: robot({ name: 'Bob' }) };

describe('the list of plans', () => {
  it('has every robot, its own plan before other tasks', () => {
    expect(shownPlans(plans, robots).map((one) => `${one.robot} ${one.graph_name}`)).toEqual([
      'Ada ',
      'Bob plan_7',
      'Bob patrol',
    ]);
  });

  it('follows the robot spoken to until a plan is picked', () => {
    const shown = shownPlans(plans, robots);
    expect(pickPlan(shown, '', ['Bob'])?.graph_name).toBe('plan_7');
    expect(pickPlan(shown, planKey({ robot: 'Bob', graph_name: 'patrol' }), ['Ada'])?.graph_name).toBe('patrol');
    expect(pickPlan([], '', [])).toBeNull();
  });
});
