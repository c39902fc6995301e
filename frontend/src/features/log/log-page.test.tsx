import { render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network, type Asked } from '@/gallery/network';
import { logPage, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { LogPage } from './log-page';

let asked: Asked[];

beforeEach(() => {
  asked = [];
  vi.stubGlobal('fetch', network({ audit: { json: logPage({ complete: false }) } }, asked));
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' }), robot({ name: 'Bob' })] }));
});

const wishes = () => asked.map(({ path }) => new URLSearchParams(path.split('?')[1])).filter((query) => !query.has('verify'));

describe('the log', () => {
  it('tells in sentences who did what, and that nobody changed it', async () => {
    render(<LogPage />);
    await screen.findByText('Kim (phone) stopped Ada.');
    await screen.findByText(/^Unbroken since/);
  });

  it('says so when it was changed', async () => {
    const chain = { entries: 3, since_unix_ms: 1, last: '', first_broken: 2, problem: 'it was changed' };
    vi.stubGlobal('fetch', network({ audit: { json: logPage({ chain }) } }));
    render(<LogPage />);
    await screen.findByText('Not as it was written from entry 2 on');
  });

  it('is narrowed by words and leads on to what is older, and back', async () => {
    const user = userEvent.setup();
    render(<LogPage />);
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
