import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { dropRule, getRules } from '@/live/api';
import { useWorld } from '@/live/store';
import type { Rule, RuleView } from '@/live/types';
import { useRobotNames } from '@/state/selection';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Empty, Loading, Panel } from '@/ui/panel';
import { useMap } from '@/ui/use-map';
import { useKept, useRequest, type Loaded } from '@/ui/use-request';

import { RuleForm } from './rule-form';
import css from './rules.module.css';
import { TryBox } from './try-box';

const NOTHING: readonly RuleView[] = [];

/** The rules: looked at, made, changed, dropped, tried. */
export function RulesPage() {
  const { t, i18n } = useTranslation(['rules', 'common']);
  const names = useRobotNames();
  const [picked, setPicked] = useState('');
  const robot = names.includes(picked) ? picked : (names[0] ?? '');
  const mapName = useWorld((world) => world.views[robot]?.map_name ?? '');
  const abilities = useWorld((world) => world.robots[robot]?.catalogue);
  const [asked, setAsked] = useState(0);
  const [editing, setEditing] = useState<Rule | 'new' | null>(null);
  const shown = useMap(robot, mapName, 0);
  const map = shown.state === 'ready' ? shown.map : null;
  const changes = useWorld((world) => world.ruleChanges);
  const found = useKept(useRequest(`${asked} ${changes} ${i18n.language}`, () => getRules(i18n.language)));
  const views = found.state === 'ready' ? (found.value.rules ?? NOTHING) : NOTHING;
  const rules = views.map((view) => view.rule);
  const done = () => {
    setEditing(null);
    setAsked(asked + 1);
  };
  const add = (
    <Button needs="rule" tone="quiet" icon="plus" onPress={() => setEditing('new')}>
      {t('add')}
    </Button>
  );
  return (
    <Panel title={t('title')} tools={add}>
      <div className={css.page}>
        <p className={css.quiet}>{t('about')}</p>
        {editing && (
          <RuleForm
            key={editing === 'new' ? '' : editing.id}
            rule={editing === 'new' ? null : editing}
            rules={rules}
            map={map}
            robots={names}
            abilities={abilities ?? []}
            onDone={done}
          />
        )}
        <Faces found={found} count={views.length} onRetry={() => setAsked(asked + 1)} />
        <ul className={css.list}>
          {views.map((view) => (
            <RuleCard key={view.rule.id} view={view} onChange={() => setEditing(view.rule)} onDropped={done} />
          ))}
        </ul>
        <TryBox robot={robot} robots={names} map={map} rules={rules} onRobot={setPicked} />
      </div>
    </Panel>
  );
}

/** What is said where there is nothing to list. */
function Faces({ found, count, onRetry }: { found: Loaded<unknown>; count: number; onRetry: () => void }) {
  const { t } = useTranslation(['rules', 'common']);
  if (found.state === 'ready') return count === 0 ? <Empty title={t('empty')} /> : null;
  if (found.state === 'loading') return <Loading />;
  return (
    <Empty title={t('failed')}>
      <p role="alert">{found.reason}</p>
      <Button onPress={onRetry}>{t('common:tryAgain')}</Button>
    </Empty>
  );
}

interface CardProps {
  view: RuleView;
  onChange: () => void;
  onDropped: () => void;
}

function RuleCard({ view: { rule, text, holds_now: holds }, onChange, onDropped }: CardProps) {
  const { t } = useTranslation('rules');
  const [sure, setSure] = useState(false);
  const drop = async () => {
    if (!sure) setSure(true);
    else if (await attempt(() => dropRule(rule.id))) onDropped();
  };
  return (
    <li className={css.card} data-kind={rule.kind}>
      <div>
        <p>
          {text} {holds === false && <span className={css.rests}>{t('rests')}</span>}
        </p>
        {rule.words && <p className={css.quiet}>{t(rule.by ? 'said' : 'told', { by: rule.by, words: rule.words })}</p>}
        {!rule.words && rule.by && <p className={css.quiet}>{t('madeBy', { by: rule.by })}</p>}
      </div>
      <div className={css.deeds}>
        <Button needs="rule" tone="quiet" icon="edit" aria-label={`${t('change')}: ${text}`} onPress={onChange}>
          {t('change')}
        </Button>
        <Button needs="rule" tone={sure ? 'danger' : 'quiet'} icon="trash" aria-label={`${t(sure ? 'dropSure' : 'drop')}: ${text}`} onPress={() => void drop()}>
          {t(sure ? 'dropSure' : 'drop')}
        </Button>
      </div>
    </li>
  );
}
