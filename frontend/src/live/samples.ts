/** Entities for tests, complete and unremarkable; a test says only what matters to it. */
import type { ChatEntry, PlanView, RobotView, ServerInfo, Snapshot, StepView } from './types';

export const robot = (part: Partial<RobotView> & { name: string }): RobotView => ({
  state: 'idle',
  connection: 'here',
  last_seen_unix_ms: 0,
  pose: null,
  at_rest: true,
  battery: null,
  map_name: '',
  policy: 'run_at_once',
  stop: { state: 'none', id: '', sent_unix_ms: 0, at_rest_unix_ms: 0 },
  graphs: {},
  catalogue: [],
  ...part,
});

export const entry = (part: Partial<ChatEntry> & { id: string }): ChatEntry => ({
  seq: 0,
  unix_ms: Date.UTC(2026, 0, 2, 10),
  who: 'robot',
  author: '',
  targets: ['Ada'],
  type: 'response',
  message: part.id,
  images: [],
  choices: [],
  sources: [],
  question: '',
  answer_id: '',
  reply_to: '',
  draft: false,
  ...part,
});

export const step = (part: Partial<StepView> & { id: string }): StepView => ({
  action: 'GoTo',
  label: part.id,
  reason: '',
  state: 'queued',
  inputs: [],
  outputs: [],
  progress: null,
  progress_text: '',
  message: '',
  risk: 'low',
  call: { GoTo: { input_parameters: {}, output_parameters: {} } },
  started_unix_ms: 0,
  ended_unix_ms: 0,
  ...part,
});

export const plan = (part: Partial<PlanView> & { robot: string }): PlanView => ({
  graph_name: 'plan_1',
  kind: 'plan',
  state: 'running',
  revision: 1,
  steps: [],
  changed: [],
  ...part,
});

const info: ServerInfo = {
  version: '1',
  language: 'offline',
  offline_language: true,
  modules: {},
  examples: ['Go to the door.', 'What do you see?', 'What can you do?'],
  addresses: [],
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
  ...part,
});
