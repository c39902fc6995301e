export { HistoryPage } from './history-page';
export { LogPart } from './log-part';
