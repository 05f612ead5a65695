/** Which language a person reads: the one that was chosen in this browser, or else the first of the browser's that is here. */
import { kLanguages, speak, type Language } from './language';

const kKey = 'tractus-language';

/** "de-CH" → de; a language that is not here, or no language at all → undefined. */
export function readLanguage(tag: string | null | undefined): Language | undefined {
  const primary = tag?.trim().toLowerCase().split(/[-_]/)[0];
  return kLanguages.find((one) => one === primary);
}

function chosenLanguage(): Language | undefined {
  try {
    return readLanguage(localStorage.getItem(kKey));
  } catch {
    return undefined; // storage may be refused
  }
}

export function preferredLanguage(browser: readonly string[] = navigator.languages): Language {
  const known = browser.map(readLanguage).find((one) => one !== undefined);
  return chosenLanguage() ?? known ?? 'en';
}

/** Changes the language now and for the next visit. */
export function chooseLanguage(chosen: Language): Promise<void> {
  try {
    localStorage.setItem(kKey, chosen);
  } catch {
    // Storage may be refused; the choice then holds for this visit.
  }
  return speak(chosen);
}
