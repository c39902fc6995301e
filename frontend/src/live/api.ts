/** One function per request. Failures are `ApiError`s whose message can be shown to people. */
import { noteServerDate } from './server-time';
import type {
  ActionCall,
  ChatEntry,
  Handover,
  HistoryPage,
  Incident,
  LogPage,
  MapInfo,
  MemoryItem,
  ModelOffer,
  Policy,
  Rule,
  RulesAnswer,
  RuleVerdict,
  RuleView,
  ServerInfo,
  SessionInfo,
  StopAnswer,
} from './types';

export type { StopAnswer };
export type Unattended = ServerInfo['unattended'];

export class ApiError extends Error {
  constructor(
    /** HTTP status; 0: the server was not reached. */
    readonly status: number,
    message: string,
    /** What the person can do about it; may be empty. */
    readonly remedy = '',
  ) {
    super(message);
    this.name = 'ApiError';
  }
}

const TIMEOUT_MS = 15_000;
/** A browser carries at most 64 kB on behalf of pages that are closed, all requests together. */
const CARRIED_ON_CHARS = 4_000;

interface Problem {
  title?: unknown;
  detail?: unknown;
  remedy?: unknown;
}

const text = (value: unknown): string => (typeof value === 'string' ? value : '');

async function failure(status: number, answer: string): Promise<ApiError> {
  const problem = (await new Response(answer).json().catch(() => ({}))) as Problem; // or a proxy's page, or half of it
  return new ApiError(status, text(problem.detail) || text(problem.title), text(problem.remedy));
}

/**
 * Ask the server.
 * @throws ApiError It refused, or was not reached within the time limit.
 */
export async function request<T>(
  method: string,
  path: string,
  body?: unknown,
  timeoutMs = TIMEOUT_MS,
): Promise<T> {
  let response: Response;
  let answer: string;
  const sent = body === undefined ? null : JSON.stringify(body);
  try {
    response = await fetch(`/api/${path}`, {
      method,
      headers: {
        'Accept-Language': document.documentElement.lang || 'en',
        ...(sent === null ? {} : { 'Content-Type': 'application/json' }),
      },
      body: sent,
      credentials: 'same-origin',
      // What was pressed arrives, even if the page is closed at once.
      keepalive: method !== 'GET' && (sent?.length ?? 0) <= CARRIED_ON_CHARS,
      signal: AbortSignal.timeout(timeoutMs),
    });
    answer = await response.text(); // it may be cut off in the middle
  } catch {
    throw new ApiError(0, '');
  }
  noteServerDate(response.headers.get('date'), Date.now());
  if (!response.ok) throw await failure(response.status, answer);
  return (answer ? JSON.parse(answer) : undefined) as T;
}

const part = encodeURIComponent;

export interface OutgoingMessage {
  id: string;
  text: string;
  targets: readonly string[];
  reply_to: string;
  images: readonly { name: string; data: string }[];
  /** What robots do with it when nobody is connected any more; null: as the system does otherwise. */
  unattended?: Unattended | null;
}

export interface ChatPage {
  entries: ChatEntry[];
  complete: boolean;
}

export type PlanCommand = 'pause' | 'resume' | 'skip' | 'clear' | 'pop';

export interface Decision {
  id: string;
  /** Of what was shown. */
  digest: string;
  decision: 'approve' | 'reject' | 'edit';
  steps?: readonly ActionCall[];
}

export const getSession = () => request<SessionInfo>('GET', 'session');
export const openSession = (secret: string, name: string) =>
  request<SessionInfo>('POST', 'session', { secret, name });
export const closeSession = () => request<unknown>('DELETE', 'session');

export const sendMessage = (message: OutgoingMessage, withinMs?: number) => request<ChatEntry>('POST', 'chat', message, withinMs);

/** What was wished for, behind the question mark; what is empty is left out. */
function asked(wish: object): string {
  const given = Object.entries(wish).filter(([, value]) => Boolean(value));
  return new URLSearchParams(given.map(([name, value]) => [name, String(value)])).toString();
}

export const getChat = (wish: { before?: number; limit?: number; q?: string; robot?: string }) =>
  request<ChatPage>('GET', `chat?${asked(wish)}`);

/** A stop is tried again soon, so it is not waited for as long as other answers. */
export const STOP_TIMEOUT_MS = 1500;

export const sendStop = (targets: readonly string[], id: string) =>
  request<StopAnswer>('POST', 'stop', { command: 'stop', targets, id }, STOP_TIMEOUT_MS);
export const sendReset = (targets: readonly string[], id: string) =>
  request<unknown>('POST', 'stop', { command: 'reset', targets, id });

/** @param step The one that is meant by a skip, as it was shown: the plan may be another by now. */
export const commandPlan = (robot: string, command: PlanCommand, step = '') =>
  request<unknown>('POST', `plans/${part(robot)}/command`, step ? { command, step } : { command });
export const decidePlan = (robot: string, decision: Decision) =>
  request<unknown>('POST', `plans/${part(robot)}/decision`, decision);
export type MissionCommand = 'pause' | 'resume' | 'clear' | 'approve' | 'reject';

/** @param wish.shown By proposal what it was when it was shown; only for a yes. */
export const commandMission = (id: string, command: MissionCommand, wish: { robot?: string; shown?: Readonly<Record<string, string>> } = {}) =>
  request<unknown>('POST', `missions/${part(id)}/command`, { command, ...wish });
export const putPolicy = (robot: string, policy: Policy) =>
  request<unknown>('PUT', `plans/${part(robot)}/policy`, { policy });
export const putSteps = (robot: string, steps: readonly ActionCall[], revision: number, undoes?: readonly string[]) =>
  request<unknown>('PUT', `plans/${part(robot)}/steps`, { steps, revision, undoes });

export const getRules = (language: string) => request<RulesAnswer>('GET', `rules?language=${part(language)}`);
export const putRule = (rule: Rule, language: string) =>
  request<RulesAnswer>('PUT', `rules/${part(rule.id)}?language=${part(language)}`, rule);
export const wordRule = (rule: Rule, language: string) =>
  request<RuleView>('POST', `rules/words?language=${part(language)}`, rule);
export const dropRule = (id: string) => request<RulesAnswer>('DELETE', `rules/${part(id)}`);
/** What would become of places in words, of a point, or of a plan; `after`: what the robot does before that. */
export interface Trial {
  words?: readonly string[];
  goal?: readonly [number, number];
  steps?: readonly ActionCall[];
  after?: readonly ActionCall[];
}
export const tryRules = (robot: string, trial: Trial, language: string) =>
  request<RuleVerdict>('POST', 'rules/try', { robot, ...trial, language });

/** `was`: the name it had so far; empty: it is new. */
export const putFavourite = (name: string, words: string, was = '') =>
  request<unknown>('PUT', `favourites${named(name)}`, { words, was });
export const dropFavourite = (name: string) => request<unknown>('DELETE', `favourites${named(name)}`);

/** Models that are here and not used; one of them is put in use, and by an empty name what was there first. */
export const getModels = () => request<ModelOffer[]>('GET', 'models');
export const putModel = (language: string) => request<unknown>('PUT', 'models', { language });

export const addRobot = (name: string) => request<unknown>('POST', 'robots', { name });
export const removeRobot = (name: string) => request<unknown>('DELETE', `robots/${part(name)}`);

export interface MemoryBody {
  type?: 'text' | 'image';
  /** The text, or the picture as base64. */
  data: string;
  info?: string;
  /** A robot's name; empty: for all. */
  scope?: string;
  /** What was forgotten a moment ago: where it came from stays known. */
  again?: boolean;
}

/** Names stand behind the question mark: no browser sends “..” or “/” as a part of a path. */
const named = (name: string, scope?: string) =>
  `?name=${part(name)}${scope === undefined ? '' : `&scope=${part(scope)}`}`;

export const searchMemories = (q: string, scope = '') =>
  request<MemoryItem[]>('GET', `memory?q=${part(q)}&scope=${part(scope)}`);
export const getMemoryHistory = (name: string, scope: string) =>
  request<MemoryItem[]>('GET', `memory/history${named(name, scope)}`);
export const putMemory = (name: string, body: MemoryBody) => request<unknown>('PUT', `memory${named(name)}`, body);
/** Without a scope it is forgotten everywhere. */
export const deleteMemory = (name: string, scope?: string) =>
  request<unknown>('DELETE', `memory${named(name, scope)}`);

/** Newest first. */
export const getIncidents = (robot: string) => request<Incident[]>('GET', `incidents?robot=${part(robot)}`);

export interface LogWish {
  robot?: string;
  by?: string;
  effect?: string;
  q?: string;
  /** Only what stands before this entry. */
  before?: number;
  limit?: number;
  verify?: boolean;
  language?: string;
}

/** Who did what, newest first. */
export const getLog = (wish: LogWish) => request<LogPage>('GET', `audit?${asked(wish)}`);

export interface HistoryWish {
  robot?: string;
  by?: string;
  q?: string;
  since?: number;
  before?: number;
  language?: string;
}

/** What robots were told to do and how it ended, newest first. */
export const getHistory = (wish: HistoryWish) => request<HistoryPage>('GET', `history?${asked(wish)}`);

/** What the next shift has to know. */
export const getHandover = (wish: HistoryWish) => request<Handover>('GET', `history/handover?${asked(wish)}`);

/** Where one round is to be had as a file. */
export const roundFile = (number: number, language: string) => `/api/history/file?${asked({ number, language })}`;

/** With what a browser subscribes to being called. */
export const getPushKey = () => request<{ key: string }>('GET', 'push');
export const putPush = (body: { endpoint: string; p256dh: string; auth: string }) => request<unknown>('PUT', 'push', body);
export const dropPush = (endpoint: string) => request<unknown>('DELETE', `push?endpoint=${part(endpoint)}`);

export const getMap = (robot: string) => request<MapInfo>('GET', `map/${part(robot)}`);
