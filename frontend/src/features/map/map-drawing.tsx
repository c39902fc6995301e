import { memo } from 'react';

import type { MapInfo, MapThing, MapView, Rule } from '@/live/types';
import { cornersOf, outline } from '@/ui/corners';

import css from './map.module.css';
import { labelOf, roomForLabels, toScreen, type Place, type Size, type Viewport } from './viewport';

export interface Rover {
  name: string;
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
  /** What is picked out. */
  marked: Place | MapThing | null;
  showScan: boolean;
  /** Rules that hold for a part of the map. */
  zones: readonly Rule[];
}

const ROBOT_M = 0.18;
const ROBOT_LEAST_PX = 11;
const LABEL_BELOW_PX = 20;

/** The map as a picture; whoever cannot see it has the list. */
export const MapDrawing = memo(function MapDrawing({ map, view, size, rovers, marked, showScan, zones }: Props) {
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
        {map.objects.map((thing) => (
          <rect
            key={thing.id}
            className={css.thing}
            data-marked={thing === marked}
            x={thing.x - thing.width / 2}
            y={thing.y - thing.height / 2}
            width={thing.width}
            height={thing.height}
          />
        ))}
        {zones.map((zone) => (
          <polygon key={zone.id} className={css.zone} data-kind={zone.kind} points={outline(cornersOf(zone)).join(' ')} />
        ))}
        {rovers.map((rover) => (
          <Way key={rover.name} rover={rover} showScan={showScan} />
        ))}
      </g>
      <Labels things={map.objects} rovers={rovers} view={view} size={size} robotPx={robotPx} />
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
      {marked && !('id' in marked) && <Pin at={toScreen(view, size, marked)} />}
    </svg>
  );
});

function Way({ rover, showScan }: { rover: Rover; showScan: boolean }) {
  const { view, pose } = rover;
  if (!view) return null;
  const points = view.path.map(([x, y]) => `${x},${y}`);
  return (
    <g className={css.way} data-chosen={rover.chosen}>
      {showScan && <path className={css.scan} d={view.scan.map(([x, y]) => `M${x} ${y}h0`).join('')} />}
      {points.length > 0 && <polyline points={[`${pose.x},${pose.y}`, ...points].join(' ')} />}
      {view.goal && points.length > 0 && <circle className={css.goal} cx={view.goal.x} cy={view.goal.y} r={0.14} />}
    </g>
  );
}

interface LabelsProps {
  things: readonly MapThing[];
  rovers: readonly Rover[];
  view: Viewport;
  size: Size;
  robotPx: number;
}

function Labels({ things, rovers, view, size, robotPx }: LabelsProps) {
  const robots = rovers.map((rover) => {
    const at = toScreen(view, size, rover.pose);
    return { id: `robot ${rover.name}`, text: rover.name, at: { x: at.x, y: at.y + robotPx + LABEL_BELOW_PX / 2 } };
  });
  const named = things.map((thing) => ({
    id: `thing ${thing.id}`,
    text: labelOf(thing, view.scale),
    at: toScreen(view, size, thing),
  }));
  const labels = [...robots, ...named];
  const written = roomForLabels(labels, size);
  return (
    <g className={css.labels}>
      {labels
        .filter((label) => written.has(label.id))
        .map((label) => (
          <text key={label.id} x={label.at.x} y={label.at.y} data-robot={label.id.startsWith('robot ')}>
            {label.text}
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
