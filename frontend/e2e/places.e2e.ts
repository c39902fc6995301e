/** A person puts rooms and things on the map; robots go there by name, a second person is told, nothing is lost. */
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';

import { barriers, hasBrowser, PATIENCE_MS, robotNamed, say, sizes, startStage, untilItMoved, type Stage } from './stage';

interface Shown {
  objects: { description: string; x: number; y: number }[];
  rooms: { name: string }[];
}

const press = (page: Page, name: string) => page.getByRole('button', { name, exact: true }).click();

async function begin(stage: Stage): Promise<Page> {
  const page = await stage.open(sizes.desktop, '#/map');
  await press(page, 'Rooms and things');
  return page;
}

/** Save what was drawn under a name. */
async function called(page: Page, name: string): Promise<void> {
  await page.getByRole('textbox', { name: 'What people call it' }).fill(name);
  await press(page, 'Put it on the map');
  await page.getByRole('button', { name: 'Draw a room' }).waitFor();
}

/** A point of the map on the screen, as parts of its width and height. */
async function point(page: Page, right: number, down: number): Promise<{ x: number; y: number }> {
  const box = await page.getByRole('application').boundingBox();
  if (!box) throw new Error('there is no map');
  return { x: box.x + box.width * right, y: box.y + box.height * down };
}

async function pick(page: Page, thing: string): Promise<void> {
  if (await page.getByRole('region', { name: 'The map as a list' }).isHidden()) await press(page, 'List');
  await press(page, `Pick ${thing}`);
}

describe.skipIf(!hasBrowser)('the first map', () => {
  let stage: Stage;

  beforeAll(async () => {
    stage = await startStage();
  });

  afterAll(async () => {
    await stage.close();
  });

  it('is drawn by hand, understood at once, told to who comes second, and there after a power cut', async () => {
    const page = await begin(stage);
    await press(page, 'Draw a room');
    const [from, to] = [await point(page, 0.46, 0.4), await point(page, 0.54, 0.6)];
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 4 });
    await page.mouse.up();
    await called(page, 'passage');
    await press(page, 'Put a thing');
    const spot = await point(page, 0.5, 0.5);
    await page.mouse.click(spot.x, spot.y);
    expect(await barriers(page)).toEqual([]);
    await called(page, 'tea corner');

    const other = await begin(stage);
    await pick(other, 'Tea corner');
    await pick(page, 'Tea corner');
    await press(other, 'Rename or move');
    await called(other, 'coffee corner');
    await press(page, 'Take off the map');
    await page.getByText(/^Somebody else changed that meanwhile/).first().waitFor();
    await pick(page, 'Coffee corner');

    const before = await robotNamed(stage);
    await page.goto(`${stage.system.address}#/`);
    await say(page, 'go to the coffee corner');
    await untilItMoved(stage, before);
    await stage.system.kill();
    await stage.system.start();
    const names = async () => {
      const { objects, rooms } = await stage.get<Partial<Shown>>('map/David');
      return [...(objects ?? []).map((thing) => thing.description), ...(rooms ?? []).map((room) => room.name)];
    };
    await expect.poll(names, { timeout: PATIENCE_MS }).toEqual(expect.arrayContaining(['passage', 'coffee corner']));
  });
});
