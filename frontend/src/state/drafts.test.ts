import { beforeEach, describe, expect, it } from 'vitest';

import { useDrafts } from './drafts';

beforeEach(() => {
  sessionStorage.clear();
  useDrafts.setState({ drafts: {} });
});

/** What a page that is loaded again begins with. */
async function loadAgain() {
  const kept = sessionStorage.getItem('parley.drafts') ?? '';
  useDrafts.setState({ drafts: {} });
  sessionStorage.setItem('parley.drafts', kept);
  await useDrafts.persist.rehydrate();
  return useDrafts.getState().drafts;
}

describe('what is half written', () => {
  it('is still there when the page is loaded again, but without its photo', async () => {
    useDrafts.getState().set('Ada', { text: 'half a sentence', photo: { name: 'door.jpg', data: 'AAAA' } });
    expect(await loadAgain()).toEqual({ Ada: { text: 'half a sentence', photo: null } });
  });

  it('goes with the tab: the device keeps nothing of it', () => {
    useDrafts.getState().set('Ada', { text: 'half a sentence' });
    expect(JSON.stringify({ ...localStorage })).not.toContain('half a sentence');
  });

  it('is gone once it was sent', async () => {
    useDrafts.getState().set('Ada', { text: 'half a sentence' });
    useDrafts.getState().set('Ada', { text: '' });
    expect(await loadAgain()).toEqual({});
  });
});
