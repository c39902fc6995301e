/** Entities for tests, complete and unremarkable; a test says only what matters to it. */
import type {
  AbilityView,
  ChatEntry,
  Incident,
  LogPage,
  MapInfo,
  MapView,
  MemoryItem,
  MissionInfo, MissionPart,
  PlanView,
  RobotView,
  RoundView,
  ServerInfo,
  Snapshot,
  StepView,
} from './types';

export const robot = (part: Partial<RobotView> & { name: string }): RobotView => ({
  state: 'idle',
  connection: 'here',
  last_seen_unix_ms: 0,
  pose: null,
  at_rest: true,
  battery: null,
  trouble: '',
  map_name: '',
  policy: 'run_at_once',
  stop: { state: 'none', id: '', sent_unix_ms: 0, at_rest_unix_ms: 0, release: 'none' },
  graphs: {},
  catalogue: [],
  ...part,
});

export const ability = (part: Partial<AbilityView> & { name: string }): AbilityView => ({
  inputs: {},
  outputs: {},
  optional: [],
  description: '',
  label: '',
  phrases: [],
  effects: [],
  risk: 'low',
  kind: 'moves',
  capabilities: [],
  examples: [],
  duration_s: null,
  timeout_s: null,
  ...part,
});

export const entry = (part: Partial<ChatEntry> & { id: string }): ChatEntry => ({
  seq: 0,
  shown_choices: [],
  unix_ms: Date.UTC(2026, 0, 2, 10),
  who: 'robot',
  author: '',
  device: '',
  targets: ['Ada'],
  type: 'response',
  message: part.id,
  images: [],
  choices: [],
  rules: [],
  sources: [],
  engine: '',
  question: '',
  asks_yes: false,
  answer_id: '',
  reply_to: '',
  draft: false,
  ...part,
});

export const logPage = (part: Partial<LogPage> = {}): LogPage => ({
  lines: [
    { number: 8, unix_ms: Date.UTC(2026, 0, 2, 10), effect: 'stop', outcome: 'done', robot: 'Ada', text: 'Kim (phone) stopped Ada.', words: '' },
    { number: 7, unix_ms: Date.UTC(2026, 0, 2, 9), effect: 'speak', outcome: 'done', robot: 'Ada', text: 'Kim (phone) said “go to the box” to Ada.', words: 'go to the box' },
  ],
  complete: true,
  chain: { entries: 8, since_unix_ms: Date.UTC(2026, 0, 1), last: '', first_broken: 0, problem: '' },
  problem: '',
  ...part,
});

export const round = (part: Partial<RoundView> & { number: number }): RoundView => ({
  robot: 'Ada',
  words: 'go to the box',
  by: 'Kim (phone)',
  approved_by: '',
  unix_ms: Date.UTC(2026, 0, 2, 9),
  ended_unix_ms: Date.UTC(2026, 0, 2, 9, 1, 5),
  worked_ms: 32_000,
  state: 'done',
  left: [],
  steps: ['Go to “box”'],
  reason: '',
  found: [],
  pictures: [],
  ...part,
});

export const step = (part: Partial<StepView> & { id: string }): StepView => ({
  planned: part.id,
  action: 'GoTo',
  label: part.id,
  reason: '',
  state: 'queued',
  inputs: [],
  outputs: [],
  progress: null,
  progress_text: '',
  message: '',
  risk: 'moves',
  call: { GoTo: { input_parameters: {}, output_parameters: {} } },
  started_unix_ms: 0,
  ended_unix_ms: 0,
  worked_ms: 0,
  working_since_unix_ms: 0,
  ends_unix_ms: 0,
  only_finds: false,
  ...part,
});

export const plan = (part: Partial<PlanView> & { robot: string }): PlanView => ({
  graph_name: 'plan_1',
  kind: 'plan',
  state: 'running',
  revision: 1,
  steps: [],
  changed: [],
  held_by: null,
  ...part,
});

const info: ServerInfo = {
  version: '1',
  language: 'built in, works without a model',
  offline_language: true,
  can_choose_language: false,
  is_language_chosen: false,
  modules: {},
  examples: ['Go to the door.', 'What do you see?', 'What can you do?'],
  shown_examples: [],
  tour: [],
  addresses: [],
  unattended: 'go_on',
  unattended_after_s: 30, stop_words: 's+t+o+p+p*|seis|hold\\s+(?:it|on)',
};

export const snapshot = (part: Partial<Snapshot> = {}): Snapshot => ({
  run: 'run-1',
  seq: 0,
  info,
  robots: [],
  chat: [],
  chat_complete: true,
  plans: [],
  proposals: [],
  feeds: [],
  incidents: [],
  views: [],
  favourites: [],
  missions: [],
  ...part,
});

export const missionPart = (part: Partial<MissionPart> & { robot: string }): MissionPart => ({
  order: `order of ${part.robot}`,
  state: 'running',
  lines: ['Check the box'],
  why: '',
  after: [],
  label: '',
  done: 0,
  count: 1,
  left: [],
  proposal: '',
  steps: [],
  instead_of: '',
  ...part,
});

export const mission = (part: Partial<MissionInfo> & { id: string }): MissionInfo => ({
  words: 'Check all boxes.',
  by: null,
  reply_to: '',
  parts: [missionPart({ robot: 'Ada' }), missionPart({ robot: 'Bob', state: 'done', done: 1 })],
  closing: '',
  ...part,
});

export const memory = (part: Partial<MemoryItem> & { name: string }): MemoryItem => ({
  scope: '',
  type: 'text',
  data: 'The box is by the door.',
  info: '', told: '',
  source: 'operator',
  way: 'told',
  words: '',
  created_unix_ms: Date.UTC(2026, 0, 2, 10),
  updated_unix_ms: Date.UTC(2026, 0, 2, 10),
  used_unix_ms: 0,
  used_count: 0,
  ...part,
});

export const incident = (part: Partial<Incident> & { id: string }): Incident => ({
  robot: 'Ada',
  graph_name: 'plan_1',
  step: { GoTo: { input_parameters: {}, output_parameters: {}, reason: 'go to the box' } } as unknown as Incident['step'],
  code: 'ambiguous',
  label: '',
  message: 'Two places fit “box”.',
  attempts: [{ kind: 'asked', asked: 'Which box?', answered: 'the red one', tried: 'I take the red box.', unix_ms: 1000 }],
  questions: 1,
  ending: 'open',
  opened_unix_ms: 1000,
  ...{ closed_unix_ms: 0, note: '' },
  ...part,
});

/** Ten metres by five, half a metre to a pixel, its corner at (-2, -1). */
export const mapInfo: MapInfo = {
  robot: 'Ada',
  name: 'hall',
  resolution: 0.5,
  width: 20,
  height: 10,
  origin: { x: -2, y: -1, yaw: 0 },
  image: 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTPyiAAAAABJRU5ErkJggg==',
  objects: [
    { id: 'box_1', kind: 'box', description: 'red box', x: 3, y: 1, width: 1, height: 1, aliases: [], found: false },
    { id: 'door_1', kind: 'door', description: 'front door', x: 0, y: 3, width: 1, height: 0.2, aliases: [], found: false },
  ],
  rooms: [{ name: 'hall', corners: [[-2, -1], [8, -1], [8, 4], [-2, 4]] }],
};

export const mapView: MapView = {
  actor: 'Ada',
  map_name: 'hall',
  pose: { x: 1, y: 2, yaw: 0 },
  places: '1f',
  room: 'hall',
  holds: '',
  path: [[3, 1]],
  goal: { x: 3, y: 1, yaw: 0 },
  scan: [[2, 2]],
  unix_ms: 1000,
};
