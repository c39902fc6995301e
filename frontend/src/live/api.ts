/** One function per request. Failures are `ApiError`s whose message can be shown to people. */
import type { ActionCall, ChatEntry, MapInfo, MemoryItem, Policy } from './types';

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

interface Problem {
  title?: unknown;
  detail?: unknown;
  remedy?: unknown;
}

const text = (value: unknown): string => (typeof value === 'string' ? value : '');

async function failure(response: Response): Promise<ApiError> {
  const problem = (await response.json().catch(() => ({}))) as Problem;
  return new ApiError(response.status, text(problem.detail) || text(problem.title), text(problem.remedy));
}

/**
 * Ask the server.
 * @throws ApiError It refused, or was not reached within the time limit.
 */
export async function request<T>(method: string, path: string, body?: unknown): Promise<T> {
  let response: Response;
  try {
    response = await fetch(`/api/${path}`, {
      method,
      headers: body === undefined ? {} : { 'Content-Type': 'application/json' },
      body: body === undefined ? null : JSON.stringify(body),
      credentials: 'same-origin',
      signal: AbortSignal.timeout(TIMEOUT_MS),
    });
  } catch {
    throw new ApiError(0, '');
  }
  if (!response.ok) throw await failure(response);
  if (response.status === 204) return undefined as T;
  const answer = await response.text();
  return (answer ? JSON.parse(answer) : undefined) as T;
}

const part = encodeURIComponent;

export interface OutgoingMessage {
  id: string;
  text: string;
  targets: readonly string[];
  reply_to: string;
  images: readonly { name: string; data: string }[];
}

export interface ChatPage {
  entries: ChatEntry[];
  complete: boolean;
}

export interface Session {
  /** Whether this server asks for a password or code. */
  required: boolean;
  authenticated: boolean;
}

export type PlanCommand = 'pause' | 'resume' | 'skip' | 'clear' | 'pop';

export interface Decision {
  id: string;
  decision: 'approve' | 'reject' | 'edit';
  steps?: readonly ActionCall[];
}

export const getSession = () => request<Session>('GET', 'session');
export const openSession = (secret: string, name: string) =>
  request<unknown>('POST', 'session', { secret, name });
export const closeSession = () => request<unknown>('DELETE', 'session');

export const sendMessage = (message: OutgoingMessage) => request<ChatEntry>('POST', 'chat', message);

export function getChat(options: { before?: number; limit?: number; q?: string; robot?: string }): Promise<ChatPage> {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(options)) {
    if (value !== undefined && value !== '') query.set(name, String(value));
  }
  return request<ChatPage>('GET', `chat?${query.toString()}`);
}

export const sendStop = (command: 'stop' | 'reset', targets: readonly string[], id: string) =>
  request<unknown>('POST', 'stop', { command, targets, id });

export const commandPlan = (robot: string, command: PlanCommand, index?: number) =>
  request<unknown>('POST', `plans/${part(robot)}/command`, index === undefined ? { command } : { command, index });
export const decidePlan = (robot: string, decision: Decision) =>
  request<unknown>('POST', `plans/${part(robot)}/decision`, decision);
export const putPolicy = (robot: string, policy: Policy) =>
  request<unknown>('PUT', `plans/${part(robot)}/policy`, { policy });
export const putSteps = (robot: string, steps: readonly ActionCall[], revision: number) =>
  request<unknown>('PUT', `plans/${part(robot)}/steps`, { steps, revision });

export const addRobot = (name: string) => request<unknown>('POST', 'robots', { name });
export const removeRobot = (name: string) => request<unknown>('DELETE', `robots/${part(name)}`);

export const searchMemories = (q: string) => request<MemoryItem[]>('GET', `memory?q=${part(q)}`);
export const putMemory = (name: string, body: { data: string; info?: string }) =>
  request<unknown>('PUT', `memory/${part(name)}`, body);
export const deleteMemory = (name: string) => request<unknown>('DELETE', `memory/${part(name)}`);

export const getMap = (robot: string) => request<MapInfo>('GET', `map/${part(robot)}`);
