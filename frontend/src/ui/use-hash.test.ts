import { act, renderHook } from '@testing-library/react';
import { beforeEach, describe, expect, it } from 'vitest';

import { goTo, useHashPath, useHashValue } from './use-hash';

beforeEach(() => {
  window.location.hash = '';
});

describe('the address after #', () => {
  it('names the page, whatever else a link says', () => {
    window.location.hash = '#/memory?name=box_place';
    expect(renderHook(() => useHashPath()).result.current[0]).toBe('/memory');
    expect(renderHook(() => useHashValue('name')).result.current).toBe('box_place');
    expect(renderHook(() => useHashValue('other')).result.current).toBe('');
  });

  it('is followed when it changes', async () => {
    const path = renderHook(() => useHashPath());
    await act(async () => {
      const changed = new Promise((resolve) => window.addEventListener('hashchange', resolve, { once: true }));
      goTo('/map');
      await changed;
    });
    expect(path.result.current[0]).toBe('/map');
  });
});
