import { render, screen } from '@testing-library/react';
import { expect, it } from 'vitest';

import { mission, missionPart } from '@/live/samples';

import { MissionCard } from './mission-card';

it('says what its buttons are about, as the plan beside it has some of the same words', () => {
  const parts = [missionPart({ robot: 'Ada', state: 'paused' }), missionPart({ robot: 'Bob', state: 'running' })];
  render(<MissionCard mission={mission({ id: 'm', words: 'check all doors', parts })} isFolded />);
  const names = screen.getAllByRole('button').map((one) => one.getAttribute('aria-label') ?? '');
  expect(names.filter(Boolean)).toEqual(['Continue all', 'Pause all', 'Cancel all'].map((deed) => `${deed}: check all doors`));
});
