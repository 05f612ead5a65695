/** The server's errors in the reader's language: by their sentence where the catalogue has it, else by their code. */
import { language, marked, say } from '@/language';

/** What each code of the server says in general; the detail is the server's own sentence, in English. */
const kCodes = new Map([
  ['bad_input', marked('What was sent is not accepted: {detail}')],
  ['out_of_range', marked('A number is outside its allowed range: {detail}')],
  ['not_found', marked('This was not found: {detail}')],
  ['corrupt', marked('A file is damaged: {detail}')],
  ['io', marked('The server could not read or write its files: {detail}')],
  ['conflict', marked('This contradicts what is there already: {detail}')],
  ['unauthorised', marked('The sign-in is not valid: {detail}')],
  ['code_needed', marked('A one-time code is needed: {detail}')],
  ['forbidden', marked('You are not allowed to do this: {detail}')],
  ['too_large', marked('This is over a limit: {detail}')],
  ['too_many', marked('Too many requests in a short time: {detail}')],
  ['unavailable', marked('This is not available just now; try again later: {detail}')],
  ['cancelled', marked('This was stopped: {detail}')],
]);

/** English is shown as it came, so is an error of a code that is not known here. */
export function errorText(code: string, english: string): string {
  if (language() === 'en') return english;
  const whole = say(english);
  if (whole !== english) return whole;
  const general = kCodes.get(code);
  return general === undefined ? english : say(general, { detail: english });
}
