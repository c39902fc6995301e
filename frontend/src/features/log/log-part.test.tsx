import { fireEvent, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { logPage, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useDrafts } from '@/state/drafts';

import { LogPart } from './log-part';
import { tableOf } from './table';

let asked: Asked[];

beforeEach(() => {
  asked = [];
  vi.stubGlobal('fetch', network({ audit: { json: logPage({ complete: false }) } }, asked));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), robot({ name: 'Bob' })] }));
});

const wishes = () => asked.map(({ path }) => new URLSearchParams(path.split('?')[1])).filter((query) => !query.has('verify'));

describe('the log', () => {
  it('tells in sentences who did what, and that nobody changed it', async () => {
    render(<LogPart />);
    await screen.findByText('Kim (phone) stopped Ada.');
    await screen.findByText(/^Unbroken since/);
  });

  it('takes an order of then up again, where one writes, and does not send it', async () => {
    render(<LogPart />);
    fireEvent.click(await screen.findByLabelText('Do again: go to the box'));
    expect(useDrafts.getState().drafts).toEqual({ Ada: { text: 'go to the box', photo: null } });
  });

  it('is a table for other programs, in which nothing is taken for a formula', () => {
    const [stop, said] = logPage().lines ?? [];
    const lines = stop && said ? [{ ...stop, text: '=1+1, he said “"”' }, said] : [];
    expect(tableOf(lines).split('\r\n').slice(1)).toEqual([
      '"7","2026-01-02T09:00:00.000Z","speak","done","Ada","Kim (phone) said “go to the box” to Ada."',
      '"8","2026-01-02T10:00:00.000Z","stop","done","Ada","\'=1+1, he said “""”"',
      '',
    ]);
  });

  it('says so when it was changed', async () => {
    const chain = { entries: 3, since_unix_ms: 1, last: '', first_broken: 2, problem: 'it was changed' };
    vi.stubGlobal('fetch', network({ audit: { json: logPage({ chain }) } }));
    render(<LogPart />);
    await screen.findByText('Not as it was written from entry 2 on');
  });

  it('is narrowed by words and leads on to what is older, and back', async () => {
    const user = userEvent.setup();
    render(<LogPart />);
    await user.type(await screen.findByLabelText('Search the log'), 'box');
    await user.click(await screen.findByRole('button', { name: 'Older' }));
    await screen.findByRole('button', { name: 'Newest' });
    expect(wishes().at(-1)?.get('q')).toBe('box');
    expect(wishes().at(-1)?.get('before')).toBe('7');
    await user.type(screen.getByLabelText('Who'), 'K');
    expect(wishes().at(-1)?.get('by')).toBe('K');
    expect(wishes().at(-1)?.has('before')).toBe(false);
  });
});
