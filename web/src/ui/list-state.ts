/** What a list shows: in the address, so that a link leads to it again. */
import * as v from 'valibot';
import { useLocation, useSearch } from 'wouter';
import { useSettled } from './use-settled';

/** Words for the server. What is absent is as usual. */
export interface Asked {
  readonly search?: string | undefined;
  readonly sort?: string | undefined;
  readonly order?: 'ascending' | 'descending' | undefined;
  readonly cursor?: string | undefined;
  readonly [filter: string]: string | undefined;
}

export interface ListState<Output extends Asked = Asked> {
  readonly asked: Output;
  /** Of `asked`, once a person has stopped typing. */
  readonly query: Output;
  /** Puts these in place of what was asked; back on the first page, unless they name another. */
  readonly change: (next: Asked) => void;
  /** Shows what a search part of an address says, and nothing else. */
  readonly open: (search: string) => void;
  /** The search part of the address of the first page; "" where all is as usual. */
  readonly search: string;
}

const kStill_ms = 250;

/** The search part of an address, without what is absent. */
export function searchOf(asked: Asked): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(asked))
    if (value !== undefined && value !== '') parameters.set(name, value);
  return parameters.toString();
}

/** What is unknown in an address counts as absent. */
export const askedOf = <Output extends Asked>(schema: v.GenericSchema<unknown, Output>, search: string): Output =>
  v.parse(schema, Object.fromEntries(new URLSearchParams(search)));

/** @param schema  the words that the list knows */
export function useList<Output extends Asked>(schema: v.GenericSchema<unknown, Output>): ListState<Output> {
  const at = useSearch();
  const [path, go] = useLocation();
  const asked = askedOf(schema, at);
  const typed = useSettled(asked.search ?? '', kStill_ms).trim();
  const show = (search: string, replace: boolean) => go(search === '' ? path : `${path}?${search}`, { replace });
  return {
    asked,
    query: { ...asked, search: typed === '' ? undefined : typed },
    // Another page is a step that the browser's button goes back.
    change: (next) => show(searchOf({ ...asked, cursor: undefined, ...next }), next.cursor === undefined),
    open: (search) => show(search, false),
    search: searchOf({ ...asked, cursor: undefined }),
  };
}
