import { useTranslation } from 'react-i18next';
import { Link } from 'wouter';

import { useWorld } from '@/live/store';
import { useSelection } from '@/state/selection';
import { Icon } from '@/ui/icon';
import { sentence } from '@/ui/words';

import { isEarlier, linesOf } from '@/live/lines';
import css from './plan-strip.module.css';
import { pickPlan, shownPlans } from './shown-plans';

/** The plan in one line, where there is no room for more; leads to the whole of it. */
export function PlanStrip() {
  const { t } = useTranslation('plan');
  const plans = useWorld((world) => world.plans);
  const robots = useWorld((world) => world.robots);
  const proposals = useWorld((world) => world.proposals);
  const chosen = useSelection();
  const waiting = Object.values(proposals)[0];
  const plan = pickPlan(shownPlans(plans, robots), '', chosen);
  if (waiting) {
    return (
      <Link className={css.strip ?? ''} href="/plan" data-asks>
        <span className={css.text}>{t('proposalTitle', { robot: waiting.robot })}</span>
        <Icon name="down" />
      </Link>
    );
  }
  if (!plan || plan.state === 'idle' || plan.state === 'ended') return null;
  const lines = linesOf(plan.steps);
  const at = lines.findIndex((line) => !isEarlier(line));
  const step = lines[at]?.step;
  return (
    <Link className={css.strip ?? ''} href="/plan">
      <span className={css.text}>
        {t(`state.${plan.state}`)}
        {step && t('stripStep', { number: at + 1, all: lines.length, step: sentence(step.label) })}
      </span>
      <Icon name="down" />
    </Link>
  );
}
