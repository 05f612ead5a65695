/** Addresses of the server's own description: a path, a parameter or a query that it does not name does not compile. */
import type { paths } from './generated/schema';

/** What a path takes: by its GET, or by its POST where it has no GET. */
type Parameters<P extends keyof paths> = paths[P] extends { get: { parameters: infer Found } }
  ? Found
  : paths[P] extends { post: { parameters: infer Found } }
    ? Found
    : never;
type PathPart<P extends keyof paths> = Parameters<P> extends { path: infer Found } ? Found : Record<string, never>;
/** What may follow the question mark, by any of the path's methods. */
type QueryOf<Operation> = Operation extends { parameters: { query?: infer Found } } ? NonNullable<Found> : never;
/** A value that is undefined is left out. */
type Sparse<Query> = Query extends unknown ? { readonly [Name in keyof Query]: Query[Name] | undefined } : never;
type QueryPart<P extends keyof paths> = Sparse<QueryOf<paths[P]['get']> | QueryOf<paths[P]['post']>>;

const kRoot = '/api/v1';

/** The address below /api/v1, with every part escaped. */
export function address<P extends keyof paths & `${typeof kRoot}${string}`>(
  path: P,
  parts: PathPart<P>,
  query?: QueryPart<P>,
): string {
  let filled: string = path.slice(kRoot.length);
  for (const [name, value] of Object.entries(parts as Record<string, unknown>)) {
    filled = filled.replace(`{${name}}`, encodeURIComponent(String(value)));
  }
  const search = new URLSearchParams();
  for (const [name, value] of Object.entries((query ?? {}) as Record<string, unknown>)) {
    if (value !== undefined) search.set(name, String(value));
  }
  return search.size > 0 ? `${filled}?${search}` : filled;
}
