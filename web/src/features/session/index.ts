export { Account } from './account';
export { OwnAccountPage } from './own-account-page';
export { SessionGate } from './session-gate';
