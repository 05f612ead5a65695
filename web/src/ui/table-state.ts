/** What a table is narrowed to and sorted by, and which page of it is shown: in the address, so that a link leads to it again. */
import { useState } from 'react';
import { useLocation, useSearch } from 'wouter';

export interface TableState {
  /** What is typed into the filter. */
  readonly typed: string;
  /** Index of the column that sorts, and its direction; null: the order in which rows come. */
  readonly sort: { readonly column: number; readonly down: boolean } | null;
  /** From 0. */
  readonly page: number;
}

export const kTableStart: TableState = { typed: '', sort: null, page: 0 };

/** `prefix` tells the tables of one page apart. */
export function readTableState(search: string, prefix: string): TableState {
  const parameters = new URLSearchParams(search);
  const [, column, way] = /^(\d+)(up|down)$/.exec(parameters.get(`${prefix}sort`) ?? '') ?? [];
  const page = Number(parameters.get(`${prefix}page`) ?? 1);
  return {
    typed: parameters.get(`${prefix}find`) ?? '',
    sort: column === undefined ? null : { column: Number(column), down: way === 'down' },
    page: Number.isInteger(page) && page >= 1 ? page - 1 : 0,
  };
}

/** The search part of an address with the state in it; the other parameters stay. */
export function withTableState(search: string, prefix: string, { typed, sort, page }: TableState): string {
  const parameters = new URLSearchParams(search);
  const put = (name: string, value: string) =>
    value === '' ? parameters.delete(prefix + name) : parameters.set(prefix + name, value);
  put('find', typed);
  put('sort', sort ? `${sort.column}${sort.down ? 'down' : 'up'}` : '');
  put('page', page === 0 ? '' : String(page + 1));
  return parameters.toString();
}

/** Without a prefix the state is of this visit alone. */
export function useTableState(prefix: string | undefined): [TableState, (next: TableState) => void] {
  const search = useSearch();
  const [path, go] = useLocation();
  const [own, setOwn] = useState(kTableStart);
  if (prefix === undefined) return [own, setOwn];
  const change = (next: TableState) => {
    const parameters = withTableState(search, prefix, next);
    go(parameters === '' ? path : `${path}?${parameters}`, { replace: true });
  };
  return [readTableState(search, prefix), change];
}
