/** Each part of the page in each of its faces. */
import { DisplayPanel } from '@/features/display';
import { IncidentsPage } from '@/features/incidents';
import { LogPart } from '@/features/log';
import { MapPanel } from '@/features/map';
import { MemoryPage } from '@/features/memory';
import { RobotsPage } from '@/features/robots';
import { MissionCard } from '@/ui/mission-card';
import { incident, logPage, mapInfo, mapView, memory, mission, missionPart, robot } from '@/live/samples';
import type { AbilityView, FeedInfo, Snapshot } from '@/live/types';

import type { Answers } from './network';

export interface Story {
  /** Part and face. */
  name: string;
  /** What the server told so far; null: nothing yet. */
  snapshot: Partial<Snapshot> | null;
  answers: Answers;
  part: () => React.ReactNode;
  /** A word of the part's own that shows this face, by its key. */
  shows: string;
}

const robots = [robot({ name: 'Ada', pose: { x: 1, y: 2, yaw: 1 } }), robot({ name: 'Bob', connection: 'lost', last_seen_unix_ms: 1 })];
const feed = (name: string, continuous: boolean): FeedInfo => ({ robot: 'Ada', name, continuous, width: 320, height: 240, last_unix_ms: 0 });
const going: AbilityView = {
  name: 'GoTo',
  description: 'Drive to a place.',
  label: '',
  phrases: ['go to {place}'],
  inputs: { place: 'string' },
  outputs: {},
  optional: [],
  effects: ['moves'],
  risk: 'high',
  kind: 'moves',
  capabilities: [],
  examples: [],
  duration_s: null,
  timeout_s: null,
};
const refused = { refused: 'The store does not answer.' };

export const stories: readonly Story[] = [
  { name: 'Pictures, loading', snapshot: null, answers: {}, part: () => <DisplayPanel />, shows: 'common:loading' },
  { name: 'Pictures, empty', snapshot: { robots }, answers: {}, part: () => <DisplayPanel />, shows: 'display:emptyText' },
  { name: 'Pictures', snapshot: { robots, feeds: [feed('camera', true), feed('inspection', false)] }, answers: {}, part: () => <DisplayPanel />, shows: 'display:names.camera' },
  { name: 'Together', snapshot: { robots }, answers: {}, part: () => <MissionCard mission={mission({ id: 'm' })} />, shows: 'missions:partsDone_other' },
  { name: 'Together, one needs help', snapshot: { robots }, answers: {}, part: () => <MissionCard mission={mission({ id: 'm', parts: [missionPart({ robot: 'Ada', state: 'held' }), missionPart({ robot: 'Bob', state: 'waiting', after: ['Ada'] })] })} />, shows: 'missions:waitsFor' },
  { name: 'Map, no robot', snapshot: {}, answers: {}, part: () => <MapPanel />, shows: 'map:noRobot' },
  { name: 'Map, loading', snapshot: { robots: [robot({ name: 'Dan' })] }, answers: { map: 'never' }, part: () => <MapPanel />, shows: 'common:loading' },
  { name: 'Map, failed', snapshot: { robots: [robot({ name: 'Dan' })] }, answers: { map: refused }, part: () => <MapPanel />, shows: 'map:empty' },
  { name: 'Map', snapshot: { robots, views: [mapView] }, answers: { map: { json: mapInfo } }, part: () => <MapPanel />, shows: 'map:tap' },
  { name: 'Memory, loading', snapshot: { robots }, answers: { memory: 'never' }, part: () => <MemoryPage />, shows: 'common:loading' },
  { name: 'Memory, empty', snapshot: { robots }, answers: { memory: { json: [] } }, part: () => <MemoryPage />, shows: 'memory:emptyText' },
  { name: 'Memory, failed', snapshot: { robots }, answers: { memory: refused }, part: () => <MemoryPage />, shows: 'memory:failed' },
  { name: 'Memory', snapshot: { robots }, answers: { memory: { json: [memory({ name: 'box_place' }), memory({ name: 'door', scope: 'Ada', source: 'Ada/Look' })] } }, part: () => <MemoryPage />, shows: 'memory:unused' },
  { name: 'Robots, loading', snapshot: null, answers: {}, part: () => <RobotsPage />, shows: 'common:loading' },
  { name: 'Robots, empty', snapshot: {}, answers: {}, part: () => <RobotsPage />, shows: 'robots:emptyText' },
  { name: 'Robots', snapshot: { robots: [...robots, robot({ name: 'Cay', battery: 0.1, catalogue: [going] })] }, answers: {}, part: () => <RobotsPage />, shows: 'robots:connection.lost' },
  { name: 'Problems, loading', snapshot: null, answers: { incidents: 'never' }, part: () => <IncidentsPage />, shows: 'common:loading' },
  { name: 'Problems, empty', snapshot: { robots }, answers: { incidents: { json: [] } }, part: () => <IncidentsPage />, shows: 'incidents:emptyText' },
  { name: 'Problems, failed', snapshot: { robots }, answers: { incidents: refused }, part: () => <IncidentsPage />, shows: 'incidents:failed' },
  { name: 'Problems', snapshot: { robots }, answers: { incidents: { json: [incident({ id: 'a' }), incident({ id: 'b', ending: 'solved' })] } }, part: () => <IncidentsPage />, shows: 'incidents:ending.solved' },
  { name: 'Log, loading', snapshot: null, answers: { audit: 'never' }, part: () => <LogPart />, shows: 'common:loading' },
  { name: 'Log, empty', snapshot: { robots }, answers: { audit: { json: logPage({ lines: [] }) } }, part: () => <LogPart />, shows: 'log:emptyText' },
  { name: 'Log, failed', snapshot: { robots }, answers: { audit: refused }, part: () => <LogPart />, shows: 'log:failed' },
  { name: 'Log', snapshot: { robots }, answers: { audit: { json: logPage({ complete: false }) } }, part: () => <LogPart />, shows: 'log:older' },
];
