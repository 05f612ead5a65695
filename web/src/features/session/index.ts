export { Account } from './account';
export { SessionGate } from './session-gate';
