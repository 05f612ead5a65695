/** What may be asked of the server's lists. A page's address has the same words, so that a link leads to the same rows. */
import * as v from 'valibot';
import { count } from './quantities';

/** Of a word that is none of these as if it were absent. */
const word = <const Words extends readonly string[]>(words: Words) =>
  v.fallback(v.optional(v.picklist(words)), undefined);
const text = v.fallback(v.optional(v.string()), undefined);
const common = { search: text, order: word(['ascending', 'descending']), cursor: text };

export const trialsAsked = v.object({
  ...common,
  sort: word(['started', 'case', 'person', 'station', 'duration']),
  answer: word(['correct', 'incorrect', 'none']),
  state: word(['assessing', 'assessed', 'failed']),
});
export const assignmentsAsked = v.object({
  ...common,
  sort: word(['urgency', 'due', 'made', 'title', 'cohort']),
  state: word(['unfinished', 'finished']),
  release: word(['held', 'released', 'at_once']),
});
export const accountsAsked = v.object({
  ...common,
  sort: word(['name', 'role', 'level', 'made']),
  role: word(['admin', 'director', 'faculty', 'researcher', 'technician', 'trainee']),
  state: word(['active', 'disabled']),
});
export const auditAsked = v.object({
  ...common,
  sort: word(['number', 'who', 'what']),
  role: word([
    'admin',
    'director',
    'faculty',
    'researcher',
    'technician',
    'trainee',
    'station',
    'command line',
    'server',
  ]),
});
export const casesAsked = v.object({
  ...common,
  sort: word(['published', 'title', 'source', 'made']),
  state: word(['available', 'retired']),
  channel: word(['drilled', 'planned']),
  felt: word(['untried', 'told', 'not_told', 'not_known']),
});

export type TrialsAsked = v.InferOutput<typeof trialsAsked>;
export type AssignmentsAsked = v.InferOutput<typeof assignmentsAsked>;
export type AccountsAsked = v.InferOutput<typeof accountsAsked>;
export type AuditAsked = v.InferOutput<typeof auditAsked>;
export type CasesAsked = v.InferOutput<typeof casesAsked>;

/** Where the rows of an answer are in their list. */
export const pageFields = {
  /** Counted to 1000. */
  total: count,
  more_than_total: v.boolean(),
  next: v.nullable(v.string()),
  previous: v.nullable(v.string()),
};

export const kRowsPerPage = 50;
/** As many as the server gives at once. */
export const kMostRows = 200;

/** All rows of a list, for a form in which one chooses among them. */
export async function everyRow<Row>(
  page: (cursor: string | undefined) => Promise<{ readonly rows: readonly Row[]; readonly next: string | null }>,
): Promise<Row[]> {
  const out: Row[] = [];
  let cursor: string | undefined;
  do {
    const { rows, next } = await page(cursor);
    out.push(...rows);
    cursor = next ?? undefined;
  } while (cursor !== undefined);
  return out;
}
