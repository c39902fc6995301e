export { BottomBar } from './bottom-bar';
export { ConnectionBanner } from './connection-banner';
export { ModelNote } from './understands';
export { here, offered, pathOf, type Page } from './pages';
export { SettingsPage } from './settings-page';
export { Sidebar } from './sidebar';
export { TopBar } from './top-bar';
