import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { ChatPanel } from '@/features/chat';
import { DisplayPanel } from '@/features/display';
import { MapPanel } from '@/features/map';
import { offered } from '@/features/menu';
import { PlanPanel } from '@/features/plan';
import { useWorld } from '@/live/store';
import { useMayAll } from '@/state/me';
import { Boundary } from '@/ui/boundary';
import { Beside, Button } from '@/ui/button';
import type { Layout } from '@/ui/use-media';

import css from './workspace.module.css';

/** The chat with pictures and map; the plan comes with the first one that there is. */
export function Workspace({ layout }: { layout: Layout }) {
  const pages = offered(useWorld((world) => world.info), useMayAll());
  const isPlanned = useWorld((world) => Object.values(world.plans).some((plan) => plan.graph_name || plan.steps.length > 0) || Object.keys(world.proposals).length > 0);
  // It stays when nothing is planned any more: no button moves away under a finger.
  const [hasPlan, setHasPlan] = useState(isPlanned);
  if (isPlanned && !hasPlan) setHasPlan(true);
  if (layout === 'phone') return <Narrow pages={pages} />;
  return (
    <div className={css.grid} data-layout={layout} data-plan={hasPlan}>
      <Area name="chat">
        <ChatPanel />
      </Area>
      {hasPlan && pages.includes('plan') && (
        <Area name="plan">
          <PlanPanel />
        </Area>
      )}
      {pages.includes('display') && (
        <Area name="display">
          <DisplayPanel />
        </Area>
      )}
      {pages.includes('map') && (
        <Area name="map">
          <MapPanel />
        </Area>
      )}
    </div>
  );
}

const strips = ['display', 'map'] as const;

/** On a phone: the conversation, and pictures or the map when wanted. */
function Narrow({ pages }: { pages: readonly string[] }) {
  const { t } = useTranslation('menu');
  const hasFeeds = useWorld((world) => Object.keys(world.feeds).length > 0);
  const [open, setOpen] = useState<(typeof strips)[number] | null>(null);
  const offered = strips.filter((name) => pages.includes(name) && (name === 'map' || hasFeeds));
  return (
    <div className={css.phone}>
      <div className={css.strips}>
        {offered.length > 0 && (
          <div className={css.pictures}>
            {offered.map((name) => (
              <Button key={name} tone="quiet" icon={open === name ? 'up' : 'down'} aria-expanded={open === name} onPress={() => setOpen(open === name ? null : name)}>
                {t(name)}
              </Button>
            ))}
            {open && (
              <Area name="strip">{open === 'map' ? <MapPanel /> : <DisplayPanel />}</Area>
            )}
          </div>
        )}
      </div>
      <Area name="chat">
        <ChatPanel />
      </Area>
    </div>
  );
}

function Area({ name, children }: { name: string; children: React.ReactNode }) {
  const { t } = useTranslation('common');
  return (
    <div className={css[name]} data-strip={name === 'strip' || undefined}>
      <Boundary message={t('crashed')} again={t('crashedAgain')}>
        <Beside value={name !== 'chat'}>{children}</Beside>
      </Boundary>
    </div>
  );
}
