import { memo } from 'react';

import type { MapInfo, MapRoom, MapThing, MapView, Rule } from '@/live/types';
import { cornersOf, outline, type Corner } from '@/ui/corners';

import css from './map.module.css';
import { nameOf, type Candidates, type Mark } from './marks';
import { PlaceMarks } from './place-marks';
import type { Trails } from './use-trails';
import type { Way as Trial } from './use-way';
import { robotLabel, roomForLabels, roomLabel, textsOf, zoneLabel, type Label } from './labels';
import { boxOf, boxOfThing, extentOf, roomAt, toScreen, type Place, type Size, type Viewport } from './viewport';

export interface Rover {
  name: string;
  /** Its name and what it carries, if it carries something. */
  title: string;
  pose: { x: number; y: number; yaw?: number };
  view: MapView | null;
  chosen: boolean;
  /** Whether it is connected; others are shown where they were last. */
  here: boolean;
}

interface Props {
  map: MapInfo;
  view: Viewport;
  size: Size;
  rovers: readonly Rover[];
  trails: Trails;
  /** What is picked out. */
  marked: Mark | null;
  /** Ways that are not driven yet: to what is picked out, and what waits for a yes. */
  trials: readonly Trial[];
  candidates: Candidates;
  showScan: boolean;
  /** Rules that hold for a part of the map. */
  zones: readonly Rule[];
  /** Rules that wait for a yes. */
  wished: readonly Rule[];
  /** The corners of an area that is being drawn. */
  drawn: readonly Corner[] | null;
}

const ROBOT_M = 0.18;
const GOAL_M = 0.14;
const ROBOT_LEAST_PX = 11;
const DOT_PX = 5;

/** The map as a picture; whoever cannot see it has the list. */
export const MapDrawing = memo(function MapDrawing({ map, view, size, rovers, trails, marked, trials, candidates, showScan, zones, wished, drawn }: Props) {
  const { x: left, y: top } = toScreen(view, size, { x: 0, y: 0 });
  const { origin, resolution } = map;
  const turned = ((origin.yaw ?? 0) * 180) / Math.PI;
  const robotPx = Math.max(ROBOT_LEAST_PX, ROBOT_M * view.scale);
  return (
    <svg className={css.drawing} viewBox={`0 0 ${size.width} ${size.height}`} aria-hidden="true">
      {/* In here: metres, y upwards. */}
      <g transform={`translate(${left} ${top}) scale(${view.scale} ${-view.scale})`}>
        <image
          className={css.floor}
          href={`data:image/png;base64,${map.image}`}
          width={map.width}
          height={map.height}
          transform={`translate(${origin.x} ${origin.y}) rotate(${turned}) translate(0 ${map.height * resolution}) scale(${resolution} ${-resolution})`}
        />
        {map.rooms.map((room) => (
          <polygon key={room.name} className={css.room} data-marked={marked?.kind === 'room' && marked.room === room} points={pointsOf(room.corners)} />
        ))}
        {map.objects.map((thing) => (
          <rect
            key={thing.id}
            className={css.thing}
            data-marked={marked?.kind === 'thing' && thing === marked.thing}
            data-candidate={candidates.has(thing.id)}
            data-found={thing.found}
            x={thing.x - thing.width / 2}
            y={thing.y - thing.height / 2}
            width={thing.width}
            height={thing.height}
          />
        ))}
        {zones.map((zone) => (
          <polygon key={zone.id} className={css.zone} data-kind={zone.kind} points={outline(cornersOf(zone)).join(' ')} />
        ))}
        {wished.map((zone) => (
          <polygon key={`wished ${zone.id}`} className={css.zone} data-kind={zone.kind} data-wished points={outline(cornersOf(zone)).join(' ')} />
        ))}
        {rovers.map(({ name, chosen }) => (
          <polyline key={name} className={css.trail} data-chosen={chosen} points={pointsOf(trails[name] ?? [])} />
        ))}
        {drawn && <Drawn corners={drawn} dotM={DOT_PX / view.scale} />}
        {trials.map((trial, index) => trial.state === 'found' && <Tried key={index} {...trial} />)}
        {rovers.map((rover) => (
          <Way key={rover.name} rover={rover} showScan={showScan} />
        ))}
      </g>
      <PlaceMarks things={map.objects} marked={marked?.kind === 'thing' ? marked.thing : null} view={view} size={size} />
      <Labels things={map.objects} rooms={map.rooms} zones={zones} candidates={candidates} rovers={rovers} goals={goalsOf(rovers, trials)} view={view} size={size} robotPx={robotPx} />
      {rovers.map((rover) => {
        const at = toScreen(view, size, rover.pose);
        const heading = (-(rover.pose.yaw ?? 0) * 180) / Math.PI;
        return (
          <g
            key={rover.name}
            className={css.robot}
            data-chosen={rover.chosen}
            data-here={rover.here}
            transform={`translate(${at.x} ${at.y}) rotate(${heading}) scale(${robotPx})`}
          >
            <circle r={1} />
            <path d="M0.62 0 L-0.36 0.5 L-0.12 0 L-0.36 -0.5 Z" />
          </g>
        );
      })}
      {marked?.kind === 'place' && <Pin at={toScreen(view, size, marked.at)} />}
    </svg>
  );
});

const pointsOf = (points: readonly (readonly [number, number])[]) => points.map(([x, y]) => `${x},${y}`).join(' ');

/** Where the ways end that are drawn. */
const goalsOf = (rovers: readonly Rover[], trials: readonly Trial[]): readonly Place[] => [
  ...rovers.flatMap(({ view }) => (view?.goal && view.path.length > 0 ? [view.goal] : [])),
  ...trials.flatMap((trial) => (trial.state === 'found' ? trial.goals.map(([x, y]) => ({ x, y })) : [])),
];

/** A way that nobody drives yet, and where the robot would stand on it. */
function Tried({ points, goals }: Extract<Trial, { state: 'found' }>) {
  return (
    <g className={css.tried}>
      <polyline points={pointsOf(points)} />
      {goals.map(([x, y], index) => (
        <circle key={index} cx={x} cy={y} r={GOAL_M} />
      ))}
    </g>
  );
}

/** An area that is no rule yet. */
function Drawn({ corners, dotM }: { corners: readonly Corner[]; dotM: number }) {
  return (
    <g className={css.drawn}>
      <polygon points={pointsOf(outline(corners))} />
      {corners.map(([x, y], index) => (
        <circle key={index} cx={x} cy={y} r={dotM} />
      ))}
    </g>
  );
}

function Way({ rover, showScan }: { rover: Rover; showScan: boolean }) {
  const { view, pose } = rover;
  if (!view) return null;
  const points = view.path.map(([x, y]) => `${x},${y}`);
  return (
    <g className={css.way} data-chosen={rover.chosen}>
      {showScan && <path className={css.scan} d={view.scan.map(([x, y]) => `M${x} ${y}h0`).join('')} />}
      {points.length > 0 && <polyline points={[`${pose.x},${pose.y}`, ...points].join(' ')} />}
      {view.goal && points.length > 0 && <circle className={css.goal} cx={view.goal.x} cy={view.goal.y} r={GOAL_M} />}
    </g>
  );
}

interface LabelsProps {
  rooms: readonly MapRoom[];
  zones: readonly Rule[];
  candidates: Candidates;
  things: readonly MapThing[];
  rovers: readonly Rover[];
  /** Ends of ways: nothing is written over them. */
  goals: readonly Place[];
  view: Viewport;
  size: Size;
  robotPx: number;
}

function Labels({ things, rooms, zones, candidates, rovers, goals, view, size, robotPx }: LabelsProps) {
  const robots = rovers.map((rover): Label => {
    const at = toScreen(view, size, rover.pose);
    return robotLabel(rover.name, rover.title, at, robotPx);
  });
  const boxes = things.map((thing) => boxOfThing(thing, view, size));
  const around = extentOf(boxes);
  const named = things.map((thing, index): Label => {
    const number = candidates.get(thing.id)?.number;
    const isOnly = !things.some((other) => other !== thing && other.kind === thing.kind);
    const texts = number ? [`${number}  ${nameOf(thing)}`, `${number}`] : textsOf(thing, view.scale, isOnly);
    const room = roomAt(rooms, thing); // over walls nothing is written
    const [id, isInside] = number ? [`candidate ${thing.id}`, true] : [`thing ${thing.id}`, false];
    return { id, texts, at: toScreen(view, size, thing), names: boxes[index], isInside, within: room ? boxOf(room.corners, view, size) : around };
  });
  const large = rooms.map((room) => roomLabel(room, things, view, size));
  // A room that is closed says its name already.
  const closed = zones.filter(({ name }) => name && !rooms.some((room) => room.name.toLowerCase() === name.toLowerCase())).map((zone) => zoneLabel(zone, things, view, size));
  const isFirst = ({ id }: Label) => id.startsWith('candidate');
  // A room's name has the whole room to stand in; where it is closed is said there or nowhere.
  const labels = [...robots, ...named.filter(isFirst), ...closed, ...large, ...named.filter((one) => !isFirst(one))];
  const at = (place: Place, radius: number) => ({ at: toScreen(view, size, place), radius });
  const marks = [...rovers.map(({ pose }) => at(pose, robotPx)), ...goals.map((goal) => at(goal, GOAL_M * view.scale))];
  return (
    <g className={css.labels}>
      {[...roomForLabels(labels, size, marks, boxes)].map(([id, { x, y, text }]) => (
        <text key={id} x={x} y={y} data-of={id.split(' ')[0]}>
          {text}
        </text>
      ))}
    </g>
  );
}

function Pin({ at }: { at: Place }) {
  return (
    <path
      className={css.pin}
      transform={`translate(${at.x} ${at.y})`}
      d="M0 0 C-3 -8 -10 -12 -10 -20 A10 10 0 0 1 10 -20 C10 -12 3 -8 0 0 Z"
    />
  );
}
