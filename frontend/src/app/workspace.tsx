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

/** Chat, plan, pictures and map side by side, as far as there is room. */
export function Workspace({ layout }: { layout: Layout }) {
  const pages = offered(useWorld((world) => world.info), useMayAll());
  if (layout === 'phone') return <Narrow hasDisplay={pages.includes('display')} />;
  return (
    <div className={css.grid} data-layout={layout}>
      <Area name="chat">
        <ChatPanel />
      </Area>
      {pages.includes('plan') && (
        <Area name="plan">
          <PlanPanel />
        </Area>
      )}
      {pages.includes('display') && (
        <Area name="display">
          <DisplayPanel />
        </Area>
      )}
      {layout === 'desktop' && pages.includes('map') && (
        <Area name="map">
          <MapPanel />
        </Area>
      )}
    </div>
  );
}

/** On a phone: the conversation, and pictures when wanted. */
function Narrow({ hasDisplay }: { hasDisplay: boolean }) {
  const { t } = useTranslation('menu');
  const some = useWorld((world) => Object.keys(world.feeds).length > 0);
  const [pictures, setPictures] = useState(false);
  return (
    <div className={css.phone}>
      <div className={css.strips}>
        {some && hasDisplay && (
          <div className={css.pictures}>
            <Button tone="quiet" icon={pictures ? 'up' : 'down'} aria-expanded={pictures} onPress={() => setPictures(!pictures)}>
              {t('display')}
            </Button>
            {pictures && (
              <Area name="strip">
                <DisplayPanel />
              </Area>
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
    <div className={css[name]}>
      <Boundary message={t('crashed')} again={t('crashedAgain')}>
        <Beside value={name !== 'chat'}>{children}</Beside>
      </Boundary>
    </div>
  );
}
