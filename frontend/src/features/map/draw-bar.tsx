import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { putRule, wordRule } from '@/live/api';
import type { Rule } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { areaOf, idFor } from '@/ui/corners';
import { TextField } from '@/ui/text-field';
import { useKept, useRequest } from '@/ui/use-request';

import type { Area } from './areas';
import css from './map.module.css';

interface Props {
  area: Area;
  mapName: string;
  rules: readonly Rule[];
  onDone: () => void;
}

const kinds = ['keep_out', 'slow', 'ask_zone'] as const;
const SLOW_MPS = '0.2';

/** What a drawn area becomes: a rule, in the server's words, that holds after a yes. */
export function DrawBar({ area, mapName, rules, onDone }: Props) {
  const { t, i18n } = useTranslation(['map', 'rules']);
  const [kind, setKind] = useState<(typeof kinds)[number]>('keep_out');
  const [name, setName] = useState('');
  const [speed, setSpeed] = useState(SLOW_MPS);
  const called = name.trim() || area.name;
  const rule = {
    id: idFor(`${kind} ${called}`, rules),
    kind,
    name: called,
    map: mapName,
    ...areaOf(area.corners),
    ...(kind === 'slow' && { max_speed_mps: Number(speed.replace(',', '.')) }),
  } as Rule;
  const isWhole = area.corners.length > 1;
  const told = useKept(useRequest(isWhole ? `${i18n.language}\n${JSON.stringify(rule)}` : '', () => wordRule(rule, i18n.language)));
  const save = async () => {
    if (await attempt(() => putRule(rule, i18n.language))) onDone();
  };
  if (!isWhole) {
    return (
      <div className={css.bar} role="status">
        <p className={css.hint}>{t('drawHint')}</p>
        <Button onPress={onDone}>{t('rules:cancel')}</Button>
      </div>
    );
  }
  return (
    <div className={css.drawBar} role="group" aria-label={t('drawn')}>
      <Choice label={t('rules:kind')} value={kind} options={kinds.map((id) => ({ id, label: t(`rules:kinds.${id}`) }))} onChange={setKind} />
      {kind === 'slow' && <TextField label={t('rules:speed')} inputMode="decimal" value={speed} onChange={setSpeed} />}
      <TextField label={t('rules:name')} placeholder={area.name} value={name} onChange={setName} maxLength={120} />
      <p role="status">
        {told.state === 'ready' && t('becomes', { rule: told.value.text })}
        {told.state === 'failed' && <span className={css.no}>{told.reason}</span>}
      </p>
      <Button onPress={onDone}>{t('rules:cancel')}</Button>
      <Button tone="main" icon="check" isDisabled={told.state !== 'ready'} onPress={() => void save()}>
        {t('rules:save')}
      </Button>
    </div>
  );
}
