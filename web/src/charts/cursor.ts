/** The moment that the pointer names, shared by every drawing of a trial without drawing the page anew. */
export interface Cursor {
  now(): number | null;
  set(t_s: number | null): void;
  subscribe(listener: () => void): () => void;
}

export function makeCursor(): Cursor {
  const listeners = new Set<() => void>();
  let moment: number | null = null;
  return {
    now: () => moment,
    set(t_s) {
      if (t_s === moment) return;
      moment = t_s;
      for (const listener of listeners) listener();
    },
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
