import { memo, useEffect, useMemo, useRef, useState } from 'react';
import { GridList, useDragAndDrop } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { useWorld } from '@/live/store';
import type { ActionCall, AbilityView } from '@/live/types';
import { Button } from '@/ui/button';
import { Choice } from '@/ui/choice';
import { useSame, useStable } from '@/ui/stable';
import { useMap } from '@/ui/use-map';
import { quoted } from '@/ui/words';

import { addables, callsOf, moved, nameOfAction, newStep, nudged, setInput, without, type DraftStep } from './editing';
import { EditorRow } from './editor-row';
import { forget, useKeptEdits, useLasting } from './lasting';
import { nothing, placesOf, type Places } from './place-picker';
import css from './plan-editor.module.css';

interface Props {
  /** What is being changed: what came of it so far is kept under this name until it is saved or given up. */
  id: string;
  robot: string;
  steps: readonly DraftStep[];
  /** How many stand before them. */
  before?: number;
  /** By id those that have begun since: they can be changed no more. */
  begun?: readonly string[];
  saveLabel: string;
  /** Whether it is done with, and what is kept of it can be forgotten. */
  onSave: (calls: readonly ActionCall[]) => Promise<boolean>;
  onCancel: () => void;
}

interface Removed {
  step: DraftStep;
  /** Where it stood. */
  index: number;
}

const NONE: readonly string[] = [];
const NO_ACTIONS: readonly AbilityView[] = [];

/** Steps to be put in order, changed, removed and added; drawn anew only where something of it is otherwise. */
export const PlanEditor = memo(function PlanEditor({ id, robot, steps: initial, before = 0, begun = NONE, saveLabel, onSave, onCancel }: Props) {
  const { t } = useTranslation(['plan', 'common']);
  const [drafts, setSteps] = useLasting(`${id} steps`, initial);
  const steps = useMemo(() => without(drafts, begun), [drafts, begun]);
  // What has begun is not shown, and is no less a part of the plan: it may have to wait once more.
  const become = (shown: readonly DraftStep[]) => setSteps([...drafts.filter((one) => !steps.some(({ id }) => id === one.id)), ...shown.map((one) => whole(one, drafts))]);
  const [added, setAdded] = useLasting(`${id} added`, 0);
  const [busy, setBusy] = useState(false);
  const [removed, setRemoved] = useLasting<Removed | null>(`${id} removed`, null);
  const catalogue = useSame(useWorld((world) => world.robots[robot]?.catalogue ?? NO_ACTIONS));

  const choices = useMemo(() => addables(catalogue), [catalogue]);
  const places = usePlaces(robot);
  const box = useInView(id);

  const { dragAndDropHooks } = useDragAndDrop({
    getItems: (keys) => [...keys].map((key) => ({ 'text/plain': steps.find((step) => step.id === key)?.label ?? '' })),
    onReorder: ({ keys, target }) => {
      const where = target.dropPosition === 'after' ? 'after' : 'before';
      setSteps(moved(drafts, new Set([...keys].map(String)), String(target.key), where));
    },
  });

  const move = useStable((step: DraftStep, by: -1 | 1) => become(nudged(steps, step.id, by)));

  const remove = useStable((step: DraftStep) => {
    become(steps.filter((one) => one.id !== step.id));
    setRemoved({ step, index: steps.findIndex((one) => one.id === step.id) });
  });

  const putBack = ({ step, index }: Removed) => {
    become(steps.toSpliced(index, 0, step));
    setRemoved(null);
  };

  const add = (name: string) => {
    const wanted = choices.find((one) => one.action.name === name);
    if (!wanted) return;
    become([...steps, newStep(wanted, `added to ${id} ${added}`)]);
    setAdded(added + 1);
  };

  const save = async () => {
    setBusy(true);
    if (await onSave(callsOf(steps))) forget(id);
    setBusy(false);
  };

  const cancel = () => {
    forget(id);
    onCancel();
  };

  const change = useStable((changed: DraftStep, name: string, value: string | number | boolean) =>
    become(steps.map((step) => (step.id === changed.id ? setInput(step, name, value) : step))),
  );

  return (
    <div className={css.editor} ref={box} tabIndex={-1} role="group" aria-label={t('editTitle')}>
      <p className={css.help}>{t('editHelp')}</p>
      <GridList
        aria-label={t('editTitle')}
        className={css.list ?? ''}
        style={{ counterReset: `step ${before}` }}
        selectionMode="none"
        keyboardNavigationBehavior="tab"
        dragAndDropHooks={dragAndDropHooks}
        renderEmptyState={() => <p className={css.help}>{t('editEmpty')}</p>}
      >
        {steps.map((step, index) => (
          <EditorRow
            key={step.id}
            step={step}
            catalogue={catalogue}
            places={places}
            isFirst={index === 0}
            isLast={index === steps.length - 1}
            onMove={move}
            onRemove={remove}
            onChange={change}
          />
        ))}
      </GridList>
      {catalogue.length > 0 && (
        <Choice
          label={t('addStep')}
          placeholder={t('addStepPlaceholder')}
          value={null}
          options={choices.map(({ action }) => ({ id: action.name, label: nameOfAction(action) }))}
          onChange={add}
        />
      )}
      <div className={css.buttons}>
        <div className={css.removed} role="status">
          {removed && (
            <>
              <p>{t('removed', { step: quoted(removed.step.label) })}</p>
              <Button onPress={() => putBack(removed)}>{t('common:undo')}</Button>
            </>
          )}
        </div>
        <Button onPress={cancel}>{t('common:cancel')}</Button>
        <Button tone="main" isDisabled={busy} onPress={() => void save()}>
          {saveLabel}
        </Button>
      </div>
    </div>
  );
});

/** With the search that was made for it, which has begun as well. */
function whole(step: DraftStep, drafts: readonly DraftStep[]): DraftStep {
  const finding = drafts.find(({ id }) => id === step.id)?.finding ?? [];
  return finding.length > step.finding.length ? { ...step, finding } : step;
}

/** What a robot can be sent to. */
function usePlaces(robot: string): Places {
  const mapName = useWorld((world) => world.views[robot]?.map_name ?? '');
  const shown = useMap(robot, mapName, 0);
  const map = shown.state === 'ready' ? shown.map : null;
  return useMemo(() => (map ? placesOf(map) : nothing), [map]);
}

/** Brings what was opened to the top of where it stands, and takes the keyboard there; not where it is shown again. */
function useInView(id: string) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const name = `${id} opened`;
    if (useKeptEdits.getState()[name]) return undefined;
    useKeptEdits.setState({ [name]: true });
    box.current?.focus({ preventScroll: true });
    // The rows are drawn a moment later, and without them there is nowhere to scroll to.
    const frame = requestAnimationFrame(() => box.current?.scrollIntoView({ block: 'start' }));
    return () => cancelAnimationFrame(frame);
  }, [id]);
  return box;
}
