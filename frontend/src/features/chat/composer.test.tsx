import { render, screen } from '@testing-library/react';
import { createRef } from 'react';
import { expect, it } from 'vitest';

import { entry, robot, snapshot } from '@/live/samples';
import { useLive } from '@/live/store';

import { Composer } from './composer';

it('says that an answer is to be written where none can be tapped', () => {
  useLive.getState().takeSnapshot(snapshot({ robots: [robot({ name: 'Ada' })] }));
  const asked = (choices: string[]) => {
    const question = entry({ id: 'q', message: 'Where to?', question: 'open', choices });
    return <Composer chosen={['Ada']} answering={{ question, robots: ['Ada'], others: [] }} lastSaid="" input={createRef()} />;
  };
  const { rerender } = render(asked([]));
  expect(screen.getByRole('textbox', { name: 'Write to Ada' })).toHaveProperty('placeholder', 'Write your answer to Ada');
  rerender(asked(['here', 'there']));
  expect(screen.getByRole('textbox', { name: 'Write to Ada' })).toHaveProperty('placeholder', 'Write to Ada');
});
