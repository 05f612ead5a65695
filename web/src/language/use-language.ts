import { useSyncExternalStore } from 'react';
import { language, onLanguage, type Language } from './language';

/** The language that is spoken. Whoever shows sentences stands below an element with this as its key: a change draws all anew. */
export const useLanguage = (): Language => useSyncExternalStore(onLanguage, language);
