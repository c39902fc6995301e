import { useTranslation } from 'react-i18next';

import { putPolicy } from '@/live/api';
import { useWorld } from '@/live/store';
import type { Policy } from '@/live/types';
import { attempt } from '@/state/do';
import { useMay } from '@/state/me';
import { Choice } from './choice';

const policies: readonly Policy[] = ['run_at_once', 'ask_when_risky', 'ask_first'];

/** Whether a robot begins at once or asks first. */
export function PolicyChoice({ robot }: { robot: string }) {
  const { t } = useTranslation('plan');
  const policy = useWorld((world) => world.robots[robot]?.policy ?? null);
  const may = useMay('policy');
  if (policy === null) return null;
  return (
    <Choice
      label={t('policyOf', { robot })}
      value={policy}
      isDisabled={!may}
      options={policies.map((id) => ({ id, label: t(`policies.${id}`) }))}
      onChange={(chosen) => void attempt(() => putPolicy(robot, chosen))}
    />
  );
}
