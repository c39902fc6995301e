import { useState } from 'react';
import { Checkbox, CheckboxGroup, Label } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { putRule } from '@/live/api';
import type { AbilityView, MapInfo, Rule } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { TextField } from '@/ui/text-field';
import { inWords } from '@/ui/words';

import { around, idFor, readCorners, writeCorners } from '@/ui/corners';
import { ZoneMap } from '@/ui/zone-map';
import { days, draftOf, isLimited, isZone, kinds, ruleOf, type Day, type Draft } from './draft';
import css from './rules.module.css';

interface Props {
  rule: Rule | null;
  rules: readonly Rule[];
  map: MapInfo | null;
  robots: readonly string[];
  abilities: readonly AbilityView[];
  onDone: () => void;
}

type Set = (change: Partial<Draft>) => void;

/** Makes a rule, or changes one. */
export function RuleForm({ rule, rules, map, robots, abilities, onDone }: Props) {
  const { t, i18n } = useTranslation('rules');
  const [draft, setDraft] = useState(() => draftOf(rule));
  const set: Set = (change) => setDraft((before) => ({ ...before, ...change }));
  const corners = readCorners(draft.corners) ?? [];
  const lacking = isZone(draft.kind) && corners.length < 2;
  const save = async () => {
    const id = rule?.id ?? idFor(`${draft.kind} ${draft.name || draft.what}`, rules);
    if (await attempt(() => putRule(ruleOf(draft, rule, id), i18n.language))) onDone();
  };
  return (
    <form
      className={css.form}
      onSubmit={(event) => {
        event.preventDefault();
        if (!lacking) void save();
      }}
    >
      <Choice
        label={t('kind')}
        value={draft.kind}
        options={kinds.map((kind) => ({ id: kind, label: t(`kinds.${kind}`) }))}
        onChange={(kind) => set({ kind })}
      />
      {isZone(draft.kind) && <Area draft={draft} map={map} rules={rules} set={set} />}
      {isLimited(draft.kind) && <TextField label={t('speed')} inputMode="decimal" isRequired value={draft.speed} onChange={(speed) => set({ speed })} />}
      {draft.kind === 'action' && <Which draft={draft} abilities={abilities} set={set} />}
      {draft.kind === 'plan' && <Limits draft={draft} set={set} />}
      {(draft.kind === 'action' || draft.kind === 'plan') && (
        <Choice
          label={t('verdict')}
          value={draft.verdict}
          options={(['forbid', 'ask'] as const).map((verdict) => ({ id: verdict, label: t(`verdicts.${verdict}`) }))}
          onChange={(verdict) => set({ verdict })}
        />
      )}
      <When draft={draft} set={set} />
      <Choice
        label={t('robot')}
        value={draft.robot || '*'}
        options={[{ id: '*', label: t('everyRobot') }, ...robots.map((name) => ({ id: name, label: name }))]}
        onChange={(robot) => set({ robot: robot === '*' ? '' : robot })}
      />
      <Tick isSelected={draft.exempt} onChange={(exempt) => set({ exempt })}>
        {t('exempt')}
      </Tick>
      {lacking && <p className={css.quiet}>{t('needsCorners')}</p>}
      <p className={css.buttons}>
        <Button onPress={onDone}>{t('cancel')}</Button>
        <Button tone="main" type="submit" isDisabled={lacking}>
          {t('save')}
        </Button>
      </p>
    </form>
  );
}

function Area({ draft, map, rules, set }: { draft: Draft; map: MapInfo | null; rules: readonly Rule[]; set: Set }) {
  const { t } = useTranslation('rules');
  const things = (map?.objects ?? []).map((thing) => ({ id: thing.id, label: thing.description || thing.id }));
  const take = (id: string) => {
    const thing = map?.objects.find((one) => one.id === id);
    if (thing) set({ name: draft.name || (thing.description ?? ''), corners: writeCorners(around(thing)) });
  };
  return (
    <>
      <TextField label={t('name')} value={draft.name} onChange={(name) => set({ name })} maxLength={120} />
      {things.length > 0 && <Choice label={t('place')} placeholder={t('placeChoose')} value={null} options={things} onChange={take} />}
      <TextField label={t('corners')} help={t('cornersHelp')} value={draft.corners} onChange={(corners) => set({ corners })} />
      {map && (
        <ZoneMap
          map={map}
          rules={rules.filter((one) => one.id !== draft.id)}
          draft={readCorners(draft.corners) ?? []}
          onDraw={(drawn) => set({ corners: writeCorners(drawn) })}
        />
      )}
    </>
  );
}

const classes = ['moves', 'handles_things', 'cannot_be_undone', 'unknown'] as const;

function Which({ draft, abilities, set }: { draft: Draft; abilities: readonly AbilityView[]; set: Set }) {
  const { t } = useTranslation(['rules', 'plan']);
  const options = [
    { id: '*', label: t('everything') },
    ...classes.map((kind) => ({ id: `:${kind}`, label: t('allOf', { kind: t(`plan:cares.${kind}`) }) })),
    ...abilities.map((action) => ({ id: action.name, label: action.description || inWords(action.name) })),
  ];
  return <Choice label={t('what')} value={draft.what || '*'} options={options} onChange={(what) => set({ what: what === '*' ? '' : what })} />;
}

function Limits({ draft, set }: { draft: Draft; set: Set }) {
  const { t } = useTranslation('rules');
  return (
    <div className={css.row}>
      <TextField label={t('distance')} inputMode="decimal" value={draft.distance} onChange={(distance) => set({ distance })} />
      <TextField label={t('steps')} inputMode="numeric" value={draft.steps} onChange={(steps) => set({ steps })} />
      <TextField label={t('seconds')} inputMode="decimal" value={draft.seconds} onChange={(seconds) => set({ seconds })} />
    </div>
  );
}

function When({ draft, set }: { draft: Draft; set: Set }) {
  const { t } = useTranslation('rules');
  return (
    <>
      <div className={css.row}>
        <TextField label={t('from')} value={draft.from} onChange={(from) => set({ from })} maxLength={5} />
        <TextField label={t('to')} help={t('hoursHelp')} value={draft.to} onChange={(to) => set({ to })} maxLength={5} />
      </div>
      <CheckboxGroup className={css.days ?? ''} value={[...draft.days]} onChange={(chosen) => set({ days: days.filter((day) => chosen.includes(day)) })}>
        <Label>{t('days')}</Label>
        {days.map((day: Day) => (
          <Tick key={day} value={day}>
            {t(`day.${day}`)}
          </Tick>
        ))}
      </CheckboxGroup>
    </>
  );
}

interface TickProps {
  value?: string;
  isSelected?: boolean;
  onChange?: (value: boolean) => void;
  children: React.ReactNode;
}

function Tick({ children, ...rest }: TickProps) {
  return (
    <Checkbox {...rest} className={css.tick ?? ''}>
      <span className={css.box} aria-hidden="true" />
      {children}
    </Checkbox>
  );
}
