import { useWorld } from '@/live/store';
import type { Rule } from '@/live/types';
import { useMap } from '@/ui/use-map';
import { ZoneMap } from '@/ui/zone-map';

import css from './entry.module.css';

/** Where a rule that waits for a yes would hold; its words say the same to who cannot see it. */
export function RuleMap({ robot, rules }: { robot: string; rules: readonly Rule[] }) {
  const mapName = useWorld((world) => world.views[robot]?.map_name ?? '');
  const zones = rules.filter((rule) => rule.rectangle ?? rule.polygon);
  const shown = useMap(zones.length > 0 ? robot : '', mapName, 0);
  if (shown.state !== 'ready' || zones.length === 0) return null;
  return (
    <div className={css.ruleMap} data-rule-map>
      <ZoneMap map={shown.map} rules={zones} />
    </div>
  );
}
