/** Names for the server's types; everything else imports them from here. */
import type { components } from './api-types';

type Schemas = components['schemas'];

export type Snapshot = Schemas['Snapshot'];
export type ServerInfo = Schemas['ServerInfo'];
export type RobotView = Schemas['RobotView'];
export type StopView = Schemas['StopView'];
export type StopAnswer = Schemas['StopAnswer'];
export type ChatEntry = Schemas['ChatEntry'];
export type Favourite = Schemas['Favourite'];
export type PlanView = Schemas['PlanView'];
export type ProposalView = Schemas['ProposalView'];
export type Rule = Schemas['Rule'];
export type RuleFinding = Schemas['RuleFinding'];
export type RuleVerdict = Schemas['RuleVerdict'];
export type RuleView = Schemas['RuleView'];
export type RulesAnswer = Schemas['RulesAnswer'];
export type MissionInfo = Schemas['MissionInfo'];
export type MissionPart = Schemas['MissionPart'];
export type StepView = Schemas['StepView'];
export type ParameterView = Schemas['ParameterView'];
export type ParameterInfo = Schemas['ParameterInfo'];
export type FeedInfo = Schemas['FeedInfo'];
export type MemoryItem = Schemas['MemoryItem'];
export type Incident = Schemas['Incident'];
export type Handover = Schemas['Handover'];
export type HistoryPage = Schemas['HistoryPage'];
export type RoundView = Schemas['RoundView'];
export type LogLine = Schemas['LogLine'];
export type LogPage = Schemas['LogPage'];
export type ModelOffer = Schemas['ModelOffer'];
export type MapView = Schemas['MapView'];
export type MapInfo = Schemas['MapInfo'];
export type MapRoom = Schemas['MapRoom'];
export type MapThing = Schemas['MapThing'];
export type PlaceChanged = Schemas['PlaceChanged'];
export type PlacePost = Schemas['PlacePost'];
export type AbilityView = Schemas['AbilityView'];

export type SessionInfo = Schemas['SessionInfo'];
export type MyAccount = Schemas['MyAccount'];
export type PeopleInfo = Schemas['PeopleInfo'];
export type PersonInfo = Schemas['PersonInfo'];
export type DeviceInfo = Schemas['DeviceInfo'];
export type CodeInfo = Schemas['CodeInfo'];
export type Role = PersonInfo['role'];

export type Policy = RobotView['policy'];
export type StepState = StepView['state'];
export type ActionCall = NonNullable<StepView['call']>;

export type Change =
  | Schemas['RobotChange']
  | Schemas['RobotGone']
  | Schemas['ChatChange']
  | Schemas['PlanChange']
  | Schemas['PlanGone']
  | Schemas['ProposalChange']
  | Schemas['ProposalGone']
  | Schemas['FeedChange']
  | Schemas['MemoryChange']
  | Schemas['FavouritesChange']
  | Schemas['InfoChange']
  | Schemas['MissionsChange']
  | Schemas['RulesChange']
  | Schemas['IncidentChange']
  | Schemas['RejectionChange'];
