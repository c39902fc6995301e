import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { tryRules } from '@/live/api';
import type { MapInfo, Rule, RuleFinding, RuleVerdict } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { TextField } from '@/ui/text-field';
import { ZoneMap } from '@/ui/zone-map';

import css from './rules.module.css';

interface Props {
  robot: string;
  robots: readonly string[];
  map: MapInfo | null;
  rules: readonly Rule[];
  onRobot: (robot: string) => void;
}

/** What the rules would say about a plan; nothing moves. */
export function TryBox({ robot, robots, map, rules, onRobot }: Props) {
  const { t, i18n } = useTranslation('rules');
  const [words, setWords] = useState('');
  const [verdict, setVerdict] = useState<RuleVerdict | null>(null);
  const places = words.split('\n').map((line) => line.trim()).filter(Boolean);
  const ask = () =>
    attempt(async () => {
      setVerdict(null);
      setVerdict(await tryRules(robot, { words: places }, i18n.language));
    });
  return (
    <section className={css.try} aria-labelledby="try-rules">
      <h3 id="try-rules">{t('tryTitle')}</h3>
      <p className={css.quiet}>{t('tryAbout')}</p>
      {robots.length > 1 && (
        <Choice label={t('robot')} value={robot} options={robots.map((name) => ({ id: name, label: name }))} onChange={onRobot} />
      )}
      <TextField label={t('tryWords')} rows={2} value={words} onChange={setWords} maxLength={1000} />
      <Button tone="main" isDisabled={robot === '' || places.length === 0} onPress={() => void ask()}>
        {t('tryNow')}
      </Button>
      <div role="status">{verdict && <Verdict verdict={verdict} />}</div>
      {map && <ZoneMap map={map} rules={rules} way={verdict?.way ?? []} />}
    </section>
  );
}

function Verdict({ verdict }: { verdict: RuleVerdict }) {
  const { t } = useTranslation('rules');
  const { forbidden = [], ask = [], risky = [], unknown = [] } = verdict;
  const fine = forbidden.length + ask.length + risky.length + unknown.length === 0;
  return (
    <div className={css.verdict}>
      {unknown.map((words) => (
        <p key={words}>{t('unknown', { words })}</p>
      ))}
      {fine && <p>{t('fine')}</p>}
      <Findings title={t('forbidden')} tone="bad" findings={forbidden} />
      <Findings title={t('asks')} tone="ask" findings={ask} />
      <Findings title={t('risky')} tone="ask" findings={risky} />
      <p className={css.quiet}>
        {t('length', { metres: Math.round(verdict.length_m ?? 0), seconds: Math.round(verdict.expected_s ?? 0) })}
      </p>
    </div>
  );
}

function Findings({ title, tone, findings }: { title: string; tone: string; findings: readonly RuleFinding[] }) {
  if (findings.length === 0) return null;
  return (
    <div className={css.findings} data-tone={tone}>
      <strong>{title}</strong>
      <ul>
        {findings.map((finding, index) => (
          <li key={index}>{finding.text}</li>
        ))}
      </ul>
    </div>
  );
}
