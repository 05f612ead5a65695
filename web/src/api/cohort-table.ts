/** The scored trials as a table, read from CSV. */
import Papa from 'papaparse';
import { ApiError } from './client';

/** The scored trials, column by column: numbers where every cell is one. */
export interface CohortTable {
  readonly columns: readonly { readonly name: string; readonly numbers: boolean; readonly levels: readonly string[] }[];
  readonly rows: readonly Readonly<Record<string, string>>[];
}

export function tableOf(csv: string): CohortTable {
  const {
    data: rows,
    meta,
    errors,
  } = Papa.parse<Record<string, string>>(csv, {
    header: true,
    delimiter: ',',
    skipEmptyLines: true,
  });
  const wrong = errors.find(({ type }) => type === 'Quotes');
  if (wrong) throw new ApiError('unreadable', `The server's table cannot be read: row ${wrong.row}: ${wrong.message}`);
  const names = meta.fields ?? [];
  return {
    rows,
    columns: names.map((name) => {
      const values = [...new Set(rows.map((one) => one[name] ?? '').filter((text) => text !== ''))];
      return {
        name,
        numbers: values.length > 0 && values.every((text) => Number.isFinite(Number(text))),
        levels: values.slice(0, 40),
      };
    }),
  };
}
