export { StopBanner } from './stop-banner';
