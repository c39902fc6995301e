export { MyAccountSection } from './my-account';
export { OpenNote, RoleNote } from './notes';
export { PeoplePage } from './people-page';
