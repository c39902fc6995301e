import { useEffect, useRef } from 'react';
import { useTranslation } from 'react-i18next';

import { useLive, useWorld } from '@/live/store';
import { draftKey, useDrafts } from '@/state/drafts';
import { useMood } from '@/state/mood';
import { useOutbox } from '@/state/outbox';
import { useTour } from '@/state/tour';
import { Button } from '@/ui/button';

import css from './moment.module.css';

const LETTER_MS = 30;

/** Plays a story: writes its sentences one after the other, and leaves the answers to the person. */
export function Tour({ robot, asks }: { robot: string; asks: boolean }) {
  const { t } = useTranslation('chat');
  const { lines, at, end } = useTour();
  const line = lines[at];
  const mood = useMood(robot);
  const waits = useWorld((world) => Object.values(world.proposals).some((proposal) => proposal.robot === robot));
  useEffect(() => {
    if (mood === 'stopped' || mood === 'away') end();
  }, [mood, end]);
  useEffect(() => end, [robot, end]);
  if (line === undefined) return null;
  return (
    <div className={css.bar} role="status">
      <Writing key={at} robot={robot} line={line} asks={asks || waits} isLast={at + 1 === lines.length} />
      <p>{t('showing', { number: at + 1, all: lines.length })}</p>
      <Button onPress={end}>{t('showEnd')}</Button>
    </div>
  );
}

/** Writes one sentence letter by letter, sends it, and goes on when the robot has replied and asks nothing. */
function Writing({ robot, line, asks, isLast }: { robot: string; line: string; asks: boolean; isLast: boolean }) {
  const { next, end } = useTour();
  const chat = useWorld((world) => world.chat);
  const sentAfter = useRef<number | null>(null);
  useEffect(() => {
    if (sentAfter.current !== null) return undefined;
    const key = draftKey([robot]);
    const written = () => useDrafts.getState().drafts[key]?.text ?? '';
    let count = 0;
    const still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    const timer = setInterval(() => {
      if (written() !== line.slice(0, count)) {
        end(); // the person writes themselves
        return;
      }
      if (count === line.length) {
        clearInterval(timer);
        sentAfter.current = useLive.getState().world.chat.at(-1)?.seq ?? 0;
        useDrafts.getState().set(key, { text: '' });
        void useOutbox.getState().send({ text: line, targets: [robot], reply_to: '', images: [] });
        if (isLast) end(); // what comes of it is the person's
        return;
      }
      count = still ? line.length : count + 1;
      useDrafts.getState().set(key, { text: line.slice(0, count) });
    }, LETTER_MS);
    return () => clearInterval(timer);
  }, [robot, line, isLast, end]);
  useEffect(() => {
    const from = sentAfter.current;
    const replied = from !== null && chat.some((one) => one.seq > from && one.who === 'robot' && !one.draft && one.targets.includes(robot));
    if (replied && !asks) next();
  }, [chat, asks, robot, next]);
  return null;
}
