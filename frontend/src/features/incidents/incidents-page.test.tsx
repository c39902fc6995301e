import { act, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network } from '@/gallery/network';
import { incident, plan, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useMoment } from '@/state/moment';
import { useSelectionStore } from '@/state/selection';

import { IncidentsPage } from './incidents-page';
import { merged, stepInWords } from './telling';

beforeEach(() => {
  useMoment.getState().seen();
  vi.stubGlobal('fetch', network({ incidents: { json: [incident({ id: 'a', message: 'The door was shut.' })] } }));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), robot({ name: 'Bob' })] }));
});

describe('the page of problems', () => {
  it('tells what happened, was asked, answered and tried', async () => {
    render(<IncidentsPage />);
    await screen.findByText('The door was shut.');
    screen.getByText('While doing: Go to the box');
    screen.getByText('Ada asked: Which box?');
    screen.getByText('Then somebody said: the red one');
    screen.getByText('Then: I take the red box.');
  });

  it('says that help is waited for only as long as that plan waits', async () => {
    vi.stubGlobal('fetch', network({ incidents: { json: [incident({ id: 'a', ending: 'held' })] } }));
    const robots = [robot({ name: 'Ada' })];
    useLive.getState().takeSnapshot(snapshot({ robots, plans: [plan({ robot: 'Ada', graph_name: 'plan_1', state: 'held' })] }));
    render(<IncidentsPage />);
    await screen.findByText('Waiting for help');
    act(() => useLive.getState().takeSnapshot(snapshot({ robots, plans: [plan({ robot: 'Ada', graph_name: 'plan_2', state: 'running' })] })));
    await screen.findByText('Left undone');
  });

  it('follows what happens while it is open', async () => {
    render(<IncidentsPage />);
    await screen.findByText('Open');
    const solved = incident({ id: 'a', message: 'The door was shut.', ending: 'solved' });
    act(() => useLive.getState().takeChanges([{ kind: 'incident', seq: 1, incident: solved }]));
    expect(screen.queryByText('Open')).toBeNull();
    screen.getByText('Solved');
  });

  it('leads to the moment in the conversation with that robot', async () => {
    render(<IncidentsPage />);
    await userEvent.setup().click(await screen.findByRole('button', { name: 'See it in the chat' }));
    expect(useMoment.getState().unixMs).toBe(1000);
    expect(useSelectionStore.getState().chosen).toEqual(['Ada']);
  });
});

describe('problems', () => {
  it('stand once each, the newest first, of one robot if wanted', () => {
    const old = incident({ id: 'a', opened_unix_ms: 1 });
    const late = incident({ id: 'b', opened_unix_ms: 9, robot: 'Bob' });
    const changed = { ...old, ending: 'solved' as const };
    expect(merged([old], [late, changed], '')).toEqual([late, changed]);
    expect(merged([old], [late, changed], 'Ada')).toEqual([changed]);
  });

  it('name the step by its reason, else by its action', () => {
    expect(stepInWords(incident({ id: 'a' }))).toBe('Go to the box');
    expect(stepInWords(incident({ id: 'a', label: 'go to the large box' }))).toBe('Go to the large box');
    expect(stepInWords(incident({ id: 'a', step: { LookAround: {} } as never }))).toBe('Look around');
  });
});
