import { act, fireEvent, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';

import { network } from '@/gallery/network';
import { mapInfo, mapView, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';
import { useDrafts } from '@/state/drafts';

import { MapPanel } from './map-panel';

const draft = () => Object.values(useDrafts.getState().drafts)[0]?.text;

beforeEach(() => {
  useDrafts.setState({ drafts: {} });
  useLive.getState().setConnection('connected');
  vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
  const robots = [robot({ name: 'Ada' }), robot({ name: 'Bob', pose: { x: 5, y: 3, yaw: 0 }, map_name: 'hall' })];
  useLive.getState().takeSnapshot(snapshot({ robots, views: [mapView] }));
});

const show = async () => {
  render(<MapPanel />);
  const user = userEvent.setup();
  await user.click(await screen.findByRole('button', { name: 'List' }));
  return user;
};

describe('the map', () => {
  it('puts a way to a thing into words for the chat, and does not send it', async () => {
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Pick Red box' }));
    await user.click(screen.getByRole('button', { name: 'Go there' }));
    expect(draft()).toBe('Go to the red box.');
  });

  it('mentions a thing behind what is written already', async () => {
    useDrafts.getState().set('Ada', { text: 'Look at' });
    const user = await show();
    await user.click(screen.getByRole('button', { name: 'Pick Front door' }));
    await user.click(screen.getByRole('button', { name: 'Mention' }));
    expect(draft()).toBe('Look at the front door');
  });

  it('picks a bare place by the keyboard', async () => {
    const user = await show();
    const map = screen.getByRole('application');
    fireEvent.keyDown(map, { key: 'ArrowUp' });
    fireEvent.keyDown(map, { key: 'Enter' });
    await user.click(screen.getByRole('button', { name: 'Go there' }));
    expect(draft()).toBe('Go to the point (3.00, 2.54).');
  });

  it('says in words where each robot of the same map is', async () => {
    await show();
    const list = within(screen.getByRole('region', { name: 'The map as a list' }));
    expect(list.getByText('Ada').closest('li')?.textContent).toBe('Ada is near: front door. It is on its way.');
    expect(list.getByText('Bob')).toBeTruthy();
  });

  it('stays as it was seen last, with its age, while there is no connection', async () => {
    const { unmount } = render(<MapPanel />);
    await screen.findByRole('application');
    unmount();
    act(() => useLive.getState().setConnection('lost', Date.now() - 12_000));
    vi.stubGlobal('fetch', network({ map: { refused: 'gone' } }));
    render(<MapPanel />);
    expect(screen.getByRole('application')).toBeTruthy();
    expect(screen.getByText('Not connected. This is how it was 12 seconds ago.')).toBeTruthy();
    vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
    act(() => useLive.getState().setConnection('connected'));
    await vi.waitFor(() => expect(screen.queryByText(/^Not connected/)).toBeNull());
  });

  it('says that it is connecting where none was seen yet, and shows it once there is a connection', async () => {
    useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Cay' })] }));
    useLive.getState().setConnection('lost', 1);
    render(<MapPanel />);
    expect(screen.getByText('Not connected. Trying again…')).toBeTruthy();
    act(() => useLive.getState().setConnection('connected'));
    expect(await screen.findByRole('application')).toBeTruthy();
  });
});
