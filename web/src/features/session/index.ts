export { Account } from './account';
export { sessionLanguage, useAccountLanguage, useChooseLanguage } from './account-language';
export { SessionGate } from './session-gate';
