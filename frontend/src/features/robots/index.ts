export { AddRobot } from './add-robot';
export { RobotsPage } from './robots-page';
