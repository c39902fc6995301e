export { PlanPanel } from './plan-panel';
export { PlanStrip } from './plan-strip';
