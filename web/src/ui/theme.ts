/** Light, dark or as the system says; stored, and told to what draws on a canvas. */
import { useSyncExternalStore } from 'react';

export type Theme = 'system' | 'light' | 'dark';
const kKey = 'tractus-theme';
const listeners = new Set<() => void>();
let version = 0;

function changed(): void {
  version += 1;
  for (const listener of listeners) listener();
}

function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function theme(): Theme {
  const chosen = document.documentElement.dataset.theme;
  return chosen === 'light' || chosen === 'dark' ? chosen : 'system';
}

export function setTheme(next: Theme): void {
  if (next === 'system') delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = next;
  try {
    if (next === 'system') localStorage.removeItem(kKey);
    else localStorage.setItem(kKey, next);
  } catch {
    // Storage refused: the choice holds for this page.
  }
  changed();
}

export function useTheme(): Theme {
  return useSyncExternalStore(subscribe, theme);
}

/** Counts changes of what colours resolve to: a canvas is drawn anew when it moves. */
export function usePalette(): number {
  return useSyncExternalStore(subscribe, () => version);
}

if (typeof window !== 'undefined' && typeof window.matchMedia === 'function') {
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
  window.matchMedia('print').addEventListener('change', changed);
}
