/** A class: many accounts imported, changed and given cards at once. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson, withoutPointer } from './client';
import { accountSchema } from './network-schemas';
import { count } from './quantities';
import { releasedAssignmentsSchema, type Release } from './teaching-schemas';
import type { Role } from './network-schemas';

export const importSchema = v.object({
  rows: v.array(
    v.object({
      line: count,
      name: v.string(),
      id: v.nullable(v.string()),
      role: v.string(),
      level: v.string(),
      badge: v.nullable(v.string()),
      has_pin: v.boolean(),
      error: v.nullable(v.pipe(v.string(), v.transform(withoutPointer))),
      password: v.nullable(v.string()),
    }),
  ),
  applied: v.boolean(),
});
export const changedAccountsSchema = v.object({
  accounts: v.array(v.object({ account: accountSchema, password: v.nullable(v.string()) })),
});

/** Passwords and PINs are hashed slowly on purpose, each of them. */
const kHashing_ms = 180_000;
const posted = { method: 'POST', timeout_ms: kHashing_ms } as const;

export interface ClassList {
  readonly csv: string;
  /** Id; empty: none. */
  readonly cohort: string;
  /** Of the rows that name none. */
  readonly level: string;
}
const bodyOf = ({ csv, cohort, level }: ClassList, apply: boolean) => ({
  csv,
  apply,
  ...(cohort === '' ? {} : { cohort }),
  ...(level === '' ? {} : { level }),
});
/** What would be made of the list; nothing is. */
export const classCheckQuery = (list: ClassList) =>
  queryOptions({
    queryKey: ['class-check', list],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/accounts/import', {}), importSchema, {
        ...posted,
        body: bodyOf(list, false),
        signal,
      }),
    enabled: list.csv !== '',
    retry: false,
  });
export const importClass = (list: ClassList) =>
  requestJson(address('/api/v1/accounts/import', {}), importSchema, { ...posted, body: bodyOf(list, true) });

export interface AccountChanges {
  readonly accounts: readonly { readonly id: string; readonly badge?: string; readonly pin?: string }[];
  readonly role?: Role;
  readonly level?: string;
  readonly cohort?: string;
  readonly new_passwords?: boolean;
}
export const changeAccounts = (changes: AccountChanges) =>
  requestJson(address('/api/v1/accounts/change', {}), changedAccountsSchema, { ...posted, body: changes });

export const releaseMany = (assignments: readonly string[], release: Release) =>
  requestJson(address('/api/v1/assignment-releases', {}), releasedAssignmentsSchema, {
    method: 'POST',
    body: { assignments, release },
  });

export type ImportRow = v.InferOutput<typeof importSchema>['rows'][number];
