/** What the log can be narrowed to, in the order of the list. */
export const kinds = [
  'any',
  'speak',
  'answer',
  'begin',
  'approve',
  'reject',
  'start',
  'end',
  'stop',
  'reset',
  'pause',
  'resume',
  'edit',
  'clear',
  'repair',
  'remember',
  'forget',
  'policy',
  'rule',
  'map',
  'setting',
  'people',
  'sign_in',
] as const;

export type Kind = (typeof kinds)[number];
