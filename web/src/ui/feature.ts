/** What a feature brings: its pages, and its places in the menu. One `manifest.tsx` in each folder of features/. */
import type { ReactNode } from 'react';

export interface Page {
  /** As wouter has it: "/trials/:id". Within a feature the first that fits is shown. */
  readonly path: string;
  /** @param at a parameter of the path by name, '' when it is not given */
  readonly show: (at: (name: string) => string) => ReactNode;
}

/** Roles of people, as the server names them (db/store/people/role.hpp). */
export type Role = 'admin' | 'director' | 'faculty' | 'researcher' | 'technician' | 'trainee';

export interface MenuEntry {
  readonly to: string;
  readonly name: string;
  /** Whose menu it is in. The server decides again on every call. */
  readonly roles: readonly Role[];
  /** Entries stand in rising order. */
  readonly order: number;
}

export interface Feature {
  readonly menu: readonly MenuEntry[];
  readonly pages: readonly Page[];
}
