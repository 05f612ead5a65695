/** Whose page this is: known until the person signs out, also when the session has ended by itself. */
let person: string | null = null;
let listeners: readonly (() => void)[] = [];

function note(next: string | null): void {
  person = next;
  for (const listener of listeners) listener();
}

export const notePerson = (name: string) => note(name);
export const noteSignOut = () => note(null);
export const currentPerson = () => person;

export function subscribePerson(listener: () => void): () => void {
  listeners = [...listeners, listener];
  return () => {
    listeners = listeners.filter((one) => one !== listener);
  };
}

/** Whether this page had a session that was not signed out: what the sign-in that follows has to explain. */
export const endedByItself = () => person !== null;
