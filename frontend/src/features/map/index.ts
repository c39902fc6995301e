export { MapPanel } from './map-panel';
