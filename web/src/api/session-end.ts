/** What happens to requests when the session ends in the midst of work: they wait until the person has signed in again. */
type Waiting = (samePerson: boolean) => void;

let waiting: Waiting[] = [];
let tell: () => void = () => undefined;

/** Called whenever the server answers that nobody is signed in. */
export const onSessionEnd = (listener: () => void) => {
  tell = listener;
};

/** Lets the waiting requests go on, or fail if another person has signed in. */
export function resumeRequests(samePerson: boolean): void {
  const all = waiting;
  waiting = [];
  for (const go of all) go(samePerson);
}

/** Resolves at the next sign-in: whether it is the same person's. Rejects when `signal` is aborted first. */
export function nextSignIn(signal?: AbortSignal): Promise<boolean> {
  tell();
  return new Promise((resolve, reject) => {
    waiting.push(resolve);
    signal?.addEventListener('abort', () => reject(signal.reason as Error), { once: true });
  });
}
