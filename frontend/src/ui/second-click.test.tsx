import { fireEvent, render, screen } from '@testing-library/react';
import { useState } from 'react';
import { afterEach, beforeEach, expect, it } from 'vitest';

import { holdSecondClicks } from './second-click';

let end: () => void = () => undefined;
beforeEach(() => {
  end = holdSecondClicks();
});
afterEach(() => end());

const pressed: string[] = [];
const click = (element: Element) => {
  fireEvent.pointerDown(element);
  fireEvent.click(element);
};

function Changing({ stops = false }: { stops?: boolean }) {
  const [says, setSays] = useState('Change');
  return (
    <div data-stops={stops || undefined}>
      <button type="button" onClick={() => (pressed.push(says), setSays('Skip'))}>
        {says}
      </button>
    </div>
  );
}

it('lets no second click of two meet a button that the first one did not, unless it stops robots', () => {
  pressed.length = 0;
  const { unmount } = render(<Changing />);
  click(screen.getByRole('button'));
  click(screen.getByRole('button', { name: 'Skip' }));
  expect(pressed).toEqual(['Change']);
  unmount();
  end();
  end = holdSecondClicks();
  render(<Changing stops />);
  click(screen.getByRole('button'));
  click(screen.getByRole('button'));
  expect(pressed).toEqual(['Change', 'Change', 'Skip']);
});
