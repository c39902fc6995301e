import { useTranslation } from 'react-i18next';
import { Link, Route, Switch } from 'wouter';

import { DisplayPanel } from '@/features/display';
import { IncidentsPage } from '@/features/incidents';
import { HistoryPage } from '@/features/log';
import { MapPanel } from '@/features/map';
import { MemoryPage } from '@/features/memory';
import { here, offered, pathOf, SettingsPage, type Page } from '@/features/menu';
import { MyAccountSection, PeoplePage } from '@/features/people';
import { PlanPanel } from '@/features/plan';
import { RobotsPage } from '@/features/robots';
import { RulesPage } from '@/features/rules';
import { useWorld } from '@/live/store';
import { useMayAll } from '@/state/me';
import { Empty } from '@/ui/panel';
import type { Layout } from '@/ui/use-media';

import { Workspace } from './workspace';

interface Props {
  layout: Layout;
  canSignOut: boolean;
  onSessionChanged: () => void;
}

/** The table of pages. Parts that this server has switched off have none. */
export function Pages({ layout, ...session }: Props) {
  const { t } = useTranslation('menu');
  const info = useWorld((world) => world.info);
  const may = useMayAll();
  const page: Record<Page, () => React.ReactNode> = {
    chat: () => <Workspace layout={layout} />,
    plan: () => <PlanPanel />,
    display: () => <DisplayPanel />,
    map: () => <MapPanel />,
    memory: () => <MemoryPage />,
    robots: () => <RobotsPage />,
    rules: () => <RulesPage />,
    incidents: () => <IncidentsPage />,
    log: () => <HistoryPage />,
    people: () => <PeoplePage onChanged={session.onSessionChanged} />,
    settings: () => (
      <SettingsPage>{session.canSignOut && <MyAccountSection onSignedOut={session.onSessionChanged} />}</SettingsPage>
    ),
  };
  return (
    <Switch>
      {offered(info, may).map((name) => (
        <Route key={name} path={pathOf(name)}>
          {page[name]}
        </Route>
      ))}
      {here(info).map((name) => (
        <Route key={`not ${name}`} path={pathOf(name)}>
          <Empty title={t('notForYou')}>
            <Link href={pathOf('chat')}>{t('toChat')}</Link>
          </Empty>
        </Route>
      ))}
      <Route>
        <Empty title={t('notFound')}>
          <Link href={pathOf('chat')}>{t('toChat')}</Link>
        </Empty>
      </Route>
    </Switch>
  );
}
