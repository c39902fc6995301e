import { useState } from 'react';
import { useTranslation } from 'react-i18next';

import { commandMission, type MissionCommand } from '@/live/api';
import { goesOn, isOver, missionFile, stands, waiting } from '@/live/missions';
import { useWorld } from '@/live/store';
import type { MissionInfo, MissionPart } from '@/live/types';
import { attempt } from '@/state/do';
import { Button } from './button';
import { Icon } from './icon';
import { nameList, quoted, sentence } from './words';

import css from './mission-card.module.css';

interface Props {
  mission: MissionInfo;
  /** Whether its parts are shown only when somebody wants to see them. */
  isFolded?: boolean;
}

/** What several robots do together, as one: how far all of it is, and each robot's part. */
export function MissionCard({ mission, isFolded = false }: Props) {
  const { t } = useTranslation('missions');
  const [open, setOpen] = useState(!isFolded);
  const done = mission.parts.filter((part) => part.state === 'done').length;
  const title = t('title', { words: quoted(mission.words) });
  return (
    <article className={css.card} aria-label={title} data-over={!goesOn(mission)}>
      <h3 className={css.head}>
        <button type="button" className={css.fold} aria-expanded={open} onClick={() => setOpen(!open)}>
          <span>{title}</span>
          <Icon name={open ? 'up' : 'down'} size={16} />
        </button>
      </h3>
      <p className={css.progress} role="status">
        <progress value={done} max={mission.parts.length} aria-hidden="true" />
        {t('partsDone', { done, count: mission.parts.length })}
        <Trouble parts={mission.parts} />
      </p>
      {mission.closing && <p>{mission.closing}</p>}
      <Controls mission={mission} />
      {open && (
        <>
          <ul className={css.parts}>
            {mission.parts.map((part) => (
              <Part key={part.order} mission={mission} part={part} />
            ))}
          </ul>
          <a className={css.file} href={missionFile(mission.id)} download aria-label={t('file', { words: mission.words })}>
            <Icon name="save" size={16} /> {t('fileShort')}
          </a>
        </>
      )}
    </article>
  );
}

/** Whose part stands or failed, also while the parts are folded. */
function Trouble({ parts }: { parts: readonly MissionPart[] }) {
  const { t, i18n } = useTranslation('missions');
  const states = ['held', 'away', 'interrupted', 'refused'] as const;
  return states.map((state) => {
    const robots = parts.filter((part) => part.state === state).map((part) => part.robot);
    return robots.length === 0 ? null : (
      <strong key={state}>{t('trouble', { robots: nameList(robots, i18n.language), state: t(`state.${state}`) })}</strong>
    );
  });
}

function useOrder(mission: MissionInfo) {
  const [busy, setBusy] = useState(false);
  const order = async (command: MissionCommand, wish?: Parameters<typeof commandMission>[2]) => {
    setBusy(true);
    await attempt(() => commandMission(mission.id, command, wish));
    setBusy(false);
  };
  return { busy, order };
}

/** Yes and no for all parts, or pause, continue and cancel. */
function Controls({ mission }: { mission: MissionInfo }) {
  const { t } = useTranslation('missions');
  const { busy, order } = useOrder(mission);
  const proposals = useWorld((world) => world.proposals);
  const shown = waiting(mission, proposals);
  const open = mission.parts.filter((part) => !isOver(part));
  if (open.length === 0) return null;
  const count = Object.keys(shown).length;
  if (count > 0) {
    return (
      <div className={css.buttons}>
        <Button needs="approve" tone="main" icon="check" isDisabled={busy} onPress={() => void order('approve', { shown })}>
          {t('approve', { count })}
        </Button>
        <Button needs="approve" icon="cross" isDisabled={busy} onPress={() => void order('reject')}>
          {t('reject')}
        </Button>
      </div>
    );
  }
  return (
    <div className={css.buttons}>
      {open.some(stands) && (
        <Button needs="resume" icon="play" isDisabled={busy} aria-label={`${t('resume')}: ${mission.words}`} onPress={() => void order('resume')}>
          {t('resume')}
        </Button>
      )}
      {!open.every(stands) && (
        <Button icon="pause" isDisabled={busy} aria-label={`${t('pause')}: ${mission.words}`} onPress={() => void order('pause')}>
          {t('pause')}
        </Button>
      )}
      <Button needs="clear" icon="trash" isDisabled={busy} aria-label={`${t('clear')}: ${mission.words}`} onPress={() => void order('clear')}>
        {t('clear')}
      </Button>
    </div>
  );
}

/** One robot's part: how it stands, what it is at, why it is this robot. */
function Part({ mission, part }: { mission: MissionInfo; part: MissionPart }) {
  const { t, i18n } = useTranslation('missions');
  const { busy, order } = useOrder(mission);
  const robot = part.robot;
  const after = nameList(part.after, i18n.language);
  const what = part.left.length > 0 ? part.left : part.lines;
  return (
    <li className={css.part} data-state={part.state}>
      <p>
        <strong>{robot}</strong> <span>{part.state === 'waiting' && after ? t('waitsFor', { after }) : t(`state.${part.state}`)}</span>{' '}
        {part.count > 1 && !isOver(part) && <span>{t('stepsDone', { done: part.done, count: part.count })}</span>}
      </p>
      <p>{part.label ? sentence(part.label) : what.map(sentence).join(' · ')}</p>
      {part.why && <p className={css.why}>{sentence(part.why)}</p>}
      {!isOver(part) && part.state !== 'asked' && (
        <div className={css.partButtons}>
          {stands(part) ? (
            <Button needs="resume" tone="quiet" icon="play" iconOnly isDisabled={busy} aria-label={t('resumePart', { robot })} onPress={() => void order('resume', { robot })} />
          ) : (
            <Button tone="quiet" icon="pause" iconOnly isDisabled={busy} aria-label={t('pausePart', { robot })} onPress={() => void order('pause', { robot })} />
          )}
          <Button needs="clear" tone="quiet" icon="trash" iconOnly isDisabled={busy} aria-label={t('clearPart', { robot })} onPress={() => void order('clear', { robot })} />
        </div>
      )}
    </li>
  );
}
