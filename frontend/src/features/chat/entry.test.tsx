import { render, screen } from '@testing-library/react';
import { expect, it } from 'vitest';

import { entry } from '@/live/samples';

import { Entry } from './entry';

it('says that a question was answered only where a robot waited for just that', () => {
  const head = (type: 'request' | 'response') => {
    const asked = entry({ id: type, who: 'robot', targets: ['Ada'], type, question: 'answered', message: `A ${type}?` });
    render(<Entry entry={asked} showName isStop offers={false} asks={false} onChoose={() => undefined} onEdit={() => undefined} />);
    return screen.getByText(asked.message).closest('li')?.querySelector('p')?.textContent;
  };
  expect([head('request'), head('response')]).toEqual(['Adaasked, and was answered', 'Adaasked']);
});
