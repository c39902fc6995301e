export { DisplayPanel } from './display-panel';
