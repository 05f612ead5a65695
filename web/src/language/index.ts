export { hearing } from './heard';
export {
  kLanguageNames,
  kLanguages,
  kLocales,
  language,
  locale,
  marked,
  onLanguage,
  say,
  speak,
  type Language,
  type Values,
} from './language';
export { chooseLanguage, preferredLanguage, readLanguage } from './preference';
export { Sentence } from './sentence';
export { useLanguage } from './use-language';
