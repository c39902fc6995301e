import { render, screen } from '@testing-library/react';
import { describe, expect, it } from 'vitest';

import { snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { SettingsPage } from './settings-page';

const show = (addresses: string[]) => {
  const plain = snapshot();
  useLive.getState().takeSnapshot({ ...plain, info: { ...plain.info, addresses } });
  render(<SettingsPage />);
};

describe('opening the page on another device', () => {
  it('begins with a picture to point its camera at', () => {
    show(['https://192.0.2.7:8400/']);
    screen.getByRole('img', { name: /Square code/ });
    screen.getByText('https://192.0.2.7:8400/');
  });

  it('is explained where only this computer can', () => {
    show([]);
    screen.getByText(/adding “--lan”/);
    expect(screen.queryByRole('img')).toBeNull();
  });
});
