/** Orders to several robots, as people see them. Plain functions. */
import type { MissionInfo, MissionPart, ProposalView } from './types';

const OVER: readonly MissionPart['state'][] = ['done', 'undone', 'refused', 'given'];
const STANDING: readonly MissionPart['state'][] = ['paused', 'interrupted'];

export const isOver = (part: MissionPart) => OVER.includes(part.state);
export const stands = (part: MissionPart) => STANDING.includes(part.state);
export const goesOn = (mission: MissionInfo) => mission.parts.some((part) => !isOver(part));
export const isOf = (mission: MissionInfo, robots: readonly string[]) => mission.parts.some((part) => robots.includes(part.robot));

/** Where all parts of a mission are to be had as one graph, for engineers. */
export const missionFile = (id: string) => `/api/missions/${encodeURIComponent(id)}/graph`;

/** What of a mission waits for a yes: by proposal what it is now. */
export function waiting(mission: MissionInfo, proposals: Readonly<Record<string, ProposalView>>): Readonly<Record<string, string>> {
  const known = mission.parts.flatMap((part) => proposals[part.proposal] ?? []);
  return Object.fromEntries(known.map((proposal) => [proposal.id, proposal.digest]));
}

/** Proposals that are answered with the mission they belong to. */
export const withMission = (missions: readonly MissionInfo[]): ReadonlySet<string> =>
  new Set(missions.flatMap((mission) => mission.parts.flatMap((part) => (part.proposal ? [part.proposal] : []))));
