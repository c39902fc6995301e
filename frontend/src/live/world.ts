/** What is known of the system, as plain data: a snapshot, and changes applied to it. No timers, no network. */
import type {
  Change,
  ChatEntry,
  Favourite,
  FeedInfo,
  Incident,
  MapView,
  MissionInfo,
  PlanView,
  ProposalView,
  RobotView,
  ServerInfo,
  Snapshot,
} from './types';

export interface Notice {
  id: number;
  robot: string;
  message: string;
}

export interface World {
  run: string;
  seq: number;
  info: ServerInfo | null;
  robots: Readonly<Record<string, RobotView>>;
  /** In the order of the conversation. */
  chat: readonly ChatEntry[];
  /** Whether `chat` holds the beginning of the conversation. */
  chatComplete: boolean;
  /** From this `seq` on nothing is missing in `chat`; before it there may be open questions that stand alone. */
  chatFrom: number;
  plans: Readonly<Record<string, PlanView>>;
  proposals: Readonly<Record<string, ProposalView>>;
  feeds: Readonly<Record<string, FeedInfo>>;
  incidents: Readonly<Record<string, Incident>>;
  views: Readonly<Record<string, MapView>>;
  /** Counts changes of memories: who shows memories asks again when it grows. */
  memoryChanges: number;
  /** The same for rules. */
  ruleChanges: number;
  favourites: readonly Favourite[];
  /** Orders to several robots, oldest first. */
  missions: readonly MissionInfo[];
  /** Refusals, newest last. */
  notices: readonly Notice[];
}

const KEPT_NOTICES = 20;

export const emptyWorld: World = {
  run: '',
  seq: 0,
  info: null,
  robots: {},
  chat: [],
  chatComplete: true,
  chatFrom: 0,
  plans: {},
  proposals: {},
  feeds: {},
  incidents: {},
  views: {},
  memoryChanges: 0,
  ruleChanges: 0,
  favourites: [],
  missions: [],
  notices: [],
};

export const planKey = (plan: { robot: string; graph_name: string }): string =>
  `${plan.robot}\n${plan.graph_name}`;

export const feedKey = (feed: { robot: string; name: string }): string => `${feed.robot}\n${feed.name}`;

/** The world as a snapshot tells it; earlier parts of the same conversation are kept. */
export function fromSnapshot(snapshot: Snapshot, before: World = emptyWorld): World {
  const sameRun = before.run === snapshot.run;
  const from = snapshot.chat_complete ? 0 : unbrokenFrom(snapshot.chat);
  const older = sameRun ? olderThan(before, from) : [];
  return {
    run: snapshot.run,
    seq: snapshot.seq,
    info: snapshot.info,
    robots: keyed(snapshot.robots, (robot) => robot.name),
    chat: mergeChat(older, snapshot.chat),
    chatComplete: older.length > 0 ? before.chatComplete : snapshot.chat_complete,
    chatFrom: older.length > 0 ? before.chatFrom : from,
    plans: keyed(snapshot.plans, planKey),
    proposals: keyed(snapshot.proposals, (proposal) => proposal.id),
    feeds: keyed(snapshot.feeds, feedKey),
    incidents: keyed(snapshot.incidents, (incident) => incident.id),
    views: keyed(snapshot.views, (view) => view.actor),
    memoryChanges: before.memoryChanges + 1,
    ruleChanges: before.ruleChanges + 1,
    favourites: snapshot.favourites,
    missions: snapshot.missions,
    notices: before.notices,
  };
}

/** Apply numbered changes in order; those already contained are passed over. */
export function applyChanges(world: World, changes: readonly Change[]): World {
  const fresh = changes.filter((change) => change.seq > world.seq);
  const last = fresh.at(-1);
  if (!last) return world;
  const said = fresh.flatMap((change) => (change.kind === 'chat' ? [change.entry] : []));
  const next = fresh.reduce(applyOne, world);
  return { ...next, seq: last.seq, chat: mergeChat(world.chat, said) };
}

/** Put older or changed entries where they belong; each key stands once. */
export function mergeChat(chat: readonly ChatEntry[], entries: readonly ChatEntry[]): readonly ChatEntry[] {
  if (entries.length === 0) return chat;
  const merged = [...chat];
  for (const entry of entries) {
    const known = merged.findLastIndex((other) => other.id === entry.id);
    if (known >= 0) merged[known] = entry;
    else if ((merged.at(-1)?.seq ?? -1) <= entry.seq) merged.push(entry);
    else merged.splice(insertionPoint(merged, entry.seq), 0, entry);
  }
  return merged;
}

function applyOne(world: World, change: Change): World {
  switch (change.kind) {
    case 'robot':
      return { ...world, robots: { ...world.robots, [change.robot.name]: change.robot } };
    case 'robot_gone':
      return { ...world, robots: without(world.robots, change.name) };
    case 'plan':
      return { ...world, plans: { ...world.plans, [planKey(change.plan)]: change.plan } };
    case 'plan_gone':
      return { ...world, plans: without(world.plans, planKey(change)) };
    case 'proposal':
      return { ...world, proposals: { ...world.proposals, [change.proposal.id]: change.proposal } };
    case 'proposal_gone':
      return { ...world, proposals: without(world.proposals, change.id) };
    case 'feed':
      return { ...world, feeds: { ...world.feeds, [feedKey(change.feed)]: change.feed } };
    case 'incident':
      return { ...world, incidents: { ...world.incidents, [change.incident.id]: change.incident } };
    default:
      return applyOther(world, change);
  }
}

/** What is not kept by a key of its own. */
function applyOther(world: World, change: Change): World {
  switch (change.kind) {
    case 'favourites':
      return { ...world, favourites: change.favourites };
    case 'info':
      return { ...world, info: change.info };
    case 'missions':
      return { ...world, missions: change.missions };
    case 'memory':
      return { ...world, memoryChanges: world.memoryChanges + 1 };
    case 'rules':
      return { ...world, ruleChanges: world.ruleChanges + 1 };
    case 'rejection': {
      const notice = { id: (world.notices.at(-1)?.id ?? 0) + 1, robot: change.robot, message: change.message };
      return { ...world, notices: [...world.notices, notice].slice(-KEPT_NOTICES) };
    }
    default:
      return world; // what was said is merged in one go by applyChanges
  }
}

function keyed<T>(items: readonly T[], key: (item: T) => string): Record<string, T> {
  return Object.fromEntries(items.map((item) => [key(item), item]));
}

function without<T>(record: Readonly<Record<string, T>>, key: string): Record<string, T> {
  return Object.fromEntries(Object.entries(record).filter(([name]) => name !== key));
}

/** What was known of the conversation before `from`, if it reaches up to there without a gap. */
function olderThan(before: World, from: number): readonly ChatEntry[] {
  const reaches = before.chat.some((entry) => entry.seq >= from);
  return reaches && before.chatFrom < from ? before.chat.filter((entry) => entry.seq < from) : [];
}

/** A snapshot begins with older questions that are still open, if there are any. */
function unbrokenFrom(chat: readonly ChatEntry[]): number {
  return chat.find((entry) => entry.question !== 'open')?.seq ?? chat.at(-1)?.seq ?? 0;
}

function insertionPoint(chat: readonly ChatEntry[], seq: number): number {
  let low = 0;
  let high = chat.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if ((chat[middle]?.seq ?? 0) <= seq) low = middle + 1;
    else high = middle;
  }
  return low;
}
