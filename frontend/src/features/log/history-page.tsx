import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { useMay } from '@/state/me';
import { Button } from '@/ui/button';
import { Panel } from '@/ui/panel';

import { HandoverPart } from './handover';
import css from './log.module.css';
import { LogPart } from './log-part';
import { Rounds } from './rounds';

const parts = ['rounds', 'handover', 'log'] as const;

/** What robots did, what the next shift has to know, and for those who may read it who did what. */
export function HistoryPage() {
  const { t } = useTranslation('log');
  const audits = useMay('audit');
  const [part, setPart] = useState<(typeof parts)[number]>('rounds');
  return (
    <Panel title={t('history')}>
      <div className={css.page}>
        <div className={css.parts} role="group" aria-label={t('history')}>
          {parts
            .filter((one) => one !== 'log' || audits)
            .map((one) => (
              <Button key={one} aria-pressed={one === part} onPress={() => setPart(one)}>
                {t(`parts.${one}`)}
              </Button>
            ))}
        </div>
        {part === 'rounds' && <Rounds />}
        {part === 'handover' && <HandoverPart />}
        {part === 'log' && <LogPart />}
      </div>
    </Panel>
  );
}
