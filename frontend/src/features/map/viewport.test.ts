import { describe, expect, it } from 'vitest';

import { mapInfo } from '@/live/samples';

import { freeIn, robotLabel, roomForLabels, textsOf } from './labels';
import { bounds, boxOf, fit, pan, roomAt, thingAt, toMap, toScreen, zoom } from './viewport';

const size = { width: 800, height: 400 };

describe('the part of a map on the screen', () => {
  it('is all of it at first, upright', () => {
    const view = fit(mapInfo, size);
    const { from, to } = bounds(mapInfo);
    expect(from).toEqual({ x: -2, y: -1 });
    expect(to).toEqual({ x: 8, y: 4 });
    const lower = toScreen(view, size, from);
    const upper = toScreen(view, size, to);
    expect(lower.x).toBeGreaterThanOrEqual(0);
    expect(upper.x).toBeLessThanOrEqual(size.width);
    expect(upper.y).toBeGreaterThanOrEqual(0);
    expect(lower.y).toBeGreaterThan(upper.y);
    expect(lower.y).toBeLessThanOrEqual(size.height);
  });

  it('turns with a map whose picture is turned', () => {
    const turned = { ...mapInfo, origin: { x: 0, y: 0, yaw: Math.PI / 2 } };
    expect(bounds(turned).from.x).toBeCloseTo(-5);
    expect(bounds(turned).to.y).toBeCloseTo(10);
  });

  it('leads from a place to the screen and back', () => {
    const view = { centre: { x: 1, y: -2 }, scale: 37 };
    const back = toMap(view, size, toScreen(view, size, { x: 3.25, y: 0.5 }));
    expect(back.x).toBeCloseTo(3.25);
    expect(back.y).toBeCloseTo(0.5);
  });

  it('keeps the point under the fingers while zooming', () => {
    const at = { x: 130, y: 300 };
    const before = fit(mapInfo, size);
    const after = zoom(before, size, 3, at, 1);
    expect(after.scale).toBeCloseTo(before.scale * 3);
    expect(toMap(after, size, at).x).toBeCloseTo(toMap(before, size, at).x);
    expect(toMap(after, size, at).y).toBeCloseTo(toMap(before, size, at).y);
  });

  it('is never zoomed or moved until nothing is left of it', () => {
    const view = fit(mapInfo, size);
    expect(zoom(view, size, 1e-9, { x: 0, y: 0 }, 5).scale).toBe(5);
    expect(pan(view, mapInfo, 1e6, 1e6).centre).toEqual({ x: -2, y: 4 });
  });
});

describe('pointing at a map', () => {
  it('finds the smaller of two things that lie over each other', () => {
    const small = { id: 's', kind: 'cup', description: '', x: 3, y: 1, width: 0.1, height: 0.1, aliases: [], found: false };
    expect(thingAt([...mapInfo.objects, small], { x: 3, y: 1 }, 0)?.id).toBe('s');
  });

  it('finds a narrow thing by a finger beside it, and nothing where nothing is', () => {
    expect(thingAt(mapInfo.objects, { x: 0, y: 3.15 }, 0.2)?.id).toBe('door_1');
    expect(thingAt(mapInfo.objects, { x: 6, y: 3 }, 0.2)).toBeNull();
  });
});

describe('labels on a map', () => {
  it('are left out where they would lie over an earlier one, and stay on the screen', () => {
    const label = (id: string, x: number, y: number) => ({ id, texts: ['front door'], at: { x, y } });
    const written = roomForLabels([label('a', 200, 100), label('b', 210, 104), label('c', 200, 200), label('d', 2, 50), label('e', -2, 90)], size);
    expect([...written.keys()]).toEqual(['a', 'c', 'd']);
    expect(written.get('d')?.x).toBe(32.5);
  });

  it('stand in what they name, or else beside it where neither another thing nor a robot is', () => {
    const box = (left: number, width: number) => ({ left, right: left + width, top: 100, bottom: 120 });
    const large = box(40, 80);
    const small = box(200, 20);
    const label = (id: string, names: typeof large, isInside = false) => ({ id, texts: ['front door'], at: { x: names.left, y: 110 }, names, isInside });
    const put = (labels: Parameters<typeof roomForLabels>[0], ...things: (typeof large)[]) =>
      [...roomForLabels(labels, size, [{ at: { x: 210, y: 130 }, radius: 8 }], [large, small, ...things])].map(([id, at]) => `${id} ${at.x} ${at.y}`);
    expect(put([label('large', large), label('small', small)])).toEqual(['large 80 110', 'small 210 91']); // below it is a robot
    expect(put([label('small', small)], { ...small, top: 80, bottom: 95 })).toEqual(['small 255.5 110']);
    const number = { ...label('small', small, true), texts: ['1  front door', '1'] };
    expect(put([number], { ...small, left: 221, right: 300 })).toEqual(['small 210 110']); // the number alone, on what is smaller than it
    expect(roomForLabels([number], size, [], [small]).get('small')?.text).toBe('1');
  });

  it('stand nearer to what they name than to anything else, and not half over an edge', () => {
    const gate = { left: 336, right: 340, top: 305, bottom: 348 };
    const area = { left: 279, right: 324, top: 246, bottom: 285 };
    const within = { left: 50, right: 340, top: 170, bottom: 349 };
    const gateLabel = { id: 'gate', texts: ['loading gate'], at: { x: 338, y: 326 }, names: gate, within };
    const robot = { id: 'robot', texts: ['Leo'], at: { x: 300, y: 242 }, others: [{ x: 300, y: 210 }] };
    const written = roomForLabels([robot, gateLabel], { width: 390, height: 380 }, [{ at: { x: 300, y: 226 }, radius: 6 }], [gate, area]);
    expect(written.get('gate')).toMatchObject({ x: 294, y: 326.5 }); // left of it: above, the area would seem to be called so
    expect(written.get('robot')?.y).toBe(210);
  });

  it('put the names of robots that stand close together not over each other', () => {
    const robots = [robotLabel('David', '', { x: 200, y: 100 }, 11), robotLabel('Ruth', '', { x: 230, y: 100 }, 11)];
    const marks = [200, 230].map((x) => ({ at: { x, y: 100 }, radius: 11 }));
    const [first, second] = [...roomForLabels(robots, size, marks).values()];
    expect(first?.y).toBeGreaterThan(100);
    expect(second?.y).toBeLessThan(100);
  });

  it('put the name of a room where no thing is', () => {
    const room = { name: 'hall', corners: [[0, 0], [8, 0], [8, 6], [0, 6]] as [number, number][] };
    const thing = (x: number, y: number) => ({ id: 'a', kind: 'box', description: '', x, y, width: 2, height: 1, aliases: [], found: false });
    expect(freeIn(room, [thing(1, 1)], 40)[0]).toEqual({ x: 4, y: 3 });
    const beside = freeIn(room, [thing(4, 3)], 40)[0];
    expect(Math.abs((beside?.y ?? 0) - 3)).toBeGreaterThan(0.6);
    expect(beside?.x).toBe(4);
    expect(freeIn(room, [thing(1.9, 3)], 40)[0]).toEqual({ x: 4, y: 3 });
    expect(freeIn(room, [thing(1.9, 3)], 15)[0]).not.toEqual({ x: 4, y: 3 }); // of a small map the name takes up more
  });

  it('are kept off the walls of a room', () => {
    const corners: [number, number][] = [[0, 0], [8, 0], [8, 6], [0, 6]];
    const view = { centre: { x: 4, y: 3 }, scale: 50 };
    const inner = boxOf(corners, view, size);
    const from = toScreen(view, size, { x: 0, y: 6 });
    expect([inner.left - from.x, inner.top - from.y]).toEqual([6, 6]);
    expect(inner.right - inner.left).toBe(8 * 50 - 12);
  });

  it('are those of the smallest room at a place', () => {
    const box = (name: string, from: number, to: number) => ({ name, corners: [[from, from], [to, from], [to, to], [from, to]] as [number, number][] });
    const rooms = [box('hall', 0, 8), box('corner', 0, 2), box('yard', 20, 30)];
    expect([1, 4, 25, 15].map((at) => roomAt(rooms, { x: at, y: at })?.name)).toEqual(['corner', 'hall', 'yard', undefined]);
  });

  it('are names while the map is small, and what describes a thing when it is larger', () => {
    const [box] = mapInfo.objects;
    const texts = (description: string, scale: number, isOnly = true) => box && textsOf({ ...box, description }, scale, isOnly);
    expect(texts('red box', 20)).toEqual(['red box', 'box']);
    expect(texts('very large red storage box', 20, false)).toEqual(['very large red storage box']);
    expect(texts('box by the front door', 20)).toEqual(['box']);
    expect(texts('BOX by the front door', 20)).toEqual(['BOX']);
    expect(texts('box by the front door', 100)).toEqual(['box by the front door', 'box']);
  });

  it('are the short words where the long ones would lie over another one, or leave the room', () => {
    const label = (id: string, x: number, within?: { left: number; right: number; top: number; bottom: number }) => ({ id, texts: [`the large ${id}`, id], at: { x, y: 100 }, within });
    const written = roomForLabels([label('box', 100), label('bag', 176), label('bed', 400, { left: 395, right: 460, top: 0, bottom: 300 })], size);
    expect([...written.values()].map(({ text }) => text)).toEqual(['the large box', 'bag', 'bed']);
    expect(written.get('bed')?.x).toBeGreaterThan(404);
  });
});
