export { LogPage } from './log-page';
