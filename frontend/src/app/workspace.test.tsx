import { act, render, screen } from '@testing-library/react';
import { expect, it, vi } from 'vitest';

import { network } from '@/gallery/network';
import { mapInfo, plan, robot, snapshot, step } from '@/live/samples';
import { useLive } from '@/live/store';

import { Workspace } from './workspace';

it('shows the plan from the first one on, also one that may not begin yet, and keeps it when nothing is planned', () => {
  vi.stubGlobal('fetch', network({ map: { json: mapInfo } }));
  const show = (...steps: string[]) => {
    const waits = plan({ robot: 'Ada', graph_name: '', steps: steps.map((id) => step({ id })) });
    act(() => useLive.getState().takeSnapshot(snapshot({ info: { ...snapshot().info, modules: { plan: true } }, robots: [robot({ name: 'Ada' })], plans: [waits] })));
  };
  show();
  render(<Workspace layout="desktop" />);
  const title = () => screen.queryByRole('heading', { name: 'Plan' });
  expect(title()).toBeNull();
  show('door');
  expect(title()).not.toBeNull();
  show();
  expect(title()).not.toBeNull();
});
