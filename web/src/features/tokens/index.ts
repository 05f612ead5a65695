export { AllTokensPage } from './all-tokens-page';
export { OwnTokensPage } from './own-tokens-page';
