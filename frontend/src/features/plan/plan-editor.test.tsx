import { render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { describe, expect, it, vi } from 'vitest';

import { network } from '@/gallery/network';
import { ability, mapInfo, mapView, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import type { DraftStep } from './editing';
import { PlanEditor } from './plan-editor';

const draft = (label: string): DraftStep => ({ id: label, label, action: label, inputs: [], call: { [label]: {} }, finding: [] });

const edit = (...labels: string[]) => {
  const onSave = vi.fn(() => Promise.resolve(true));
  render(<PlanEditor id="one" robot="Ada" steps={labels.map(draft)} saveLabel="Save" onSave={onSave} onCancel={vi.fn()} />);
  return { user: userEvent.setup(), saved: () => (onSave.mock.calls.flat(2) as object[]).flatMap(Object.keys) };
};

describe('editing a plan', () => {
  it('offers a step that was taken out beside the other buttons, and puts it back where it stood', async () => {
    const { user, saved } = edit('wash', 'dry', 'fold');
    const editor = within(screen.getByRole('group'));
    await user.click(editor.getByLabelText(/^Remove.*dry/));
    editor.getByText('“dry” was removed.');
    expect(editor.queryByLabelText(/^Remove.*dry/)).toBeNull();
    await user.click(editor.getByText('Undo'));
    expect(editor.queryByText('“dry” was removed.')).toBeNull();
    await user.click(editor.getByText('Save'));
    expect(saved()).toEqual(['wash', 'dry', 'fold']);
  });

  it('lets the place of a step be chosen from what is on the map', async () => {
    vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
    const go = ability({ name: 'Go', inputs: { where: 'string' }, label: 'Go to {where}', parameters: { where: { kind: 'place', unit: '', default: null, choices: [], help: '' } } });
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada', catalogue: [go] })], views: [mapView] }));
    const { user } = edit();
    await user.click(screen.getByRole('button', { name: /Add a step/ }));
    await user.click(screen.getByRole('option', { name: 'Go to …' }));
    await user.click(await screen.findByRole('button', { name: /Place/ }));
    expect(screen.getAllByRole('option').map((one) => one.textContent)).toEqual(['Front door', 'Hall', 'Red box']);
    await user.click(screen.getByRole('option', { name: 'Red box' }));
    screen.getByText('Go to “red box”');
    expect(screen.queryByRole('textbox')).toBeNull();
    await user.click(screen.getByRole('button', { name: 'On the map' }));
    const map = screen.getByRole('dialog', { name: 'Place' });
    expect(within(map).getByRole('button', { name: 'Use this place' })).toHaveProperty('disabled', true);
    await user.click(within(map).getByRole('button', { name: 'Cancel' }));
    screen.getByText('Go to “red box”');
  });
});
