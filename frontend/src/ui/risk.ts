import type { StepView } from '@/live/types';

export type RiskClass = NonNullable<StepView['risk']>;

/** Whether a step is of a kind that people are asked about wherever risky things are. */
export const needsCare = (risk: RiskClass): boolean => risk !== 'looks_and_speaks' && risk !== 'moves';
