import type { ReactNode } from 'react';
import { Scroll } from './scroll';
import { Skeleton } from './skeleton';
import styles from './table.module.css';

export interface Column<Row> {
  readonly name: ReactNode;
  readonly cell: (row: Row) => ReactNode;
  readonly number?: boolean;
}

interface Props<Row> {
  readonly caption: string;
  readonly columns: readonly Column<Row>[];
  /** undefined while they are on their way. */
  readonly rows: readonly Row[] | undefined;
  readonly keyOf: (row: Row, index: number) => string;
  readonly empty: ReactNode;
  readonly minWidth?: number;
}

const kWaiting = 4;

/** A plain table: its first column names the row. */
export function Table<Row>({ caption, columns, rows, keyOf, empty, minWidth }: Props<Row>) {
  if (rows?.length === 0) return <p className={styles.empty}>{empty}</p>;
  return (
    <Scroll label={caption}>
      <table
        className={styles.table}
        aria-busy={rows === undefined}
        style={minWidth === undefined ? undefined : { minWidth }}
      >
        <caption className="hidden-visually">{caption}</caption>
        <thead>
          <tr>
            {columns.map(({ name, number }, i) => (
              <th key={i} scope="col" className={number ? styles.number : undefined}>
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows === undefined
            ? Array.from({ length: kWaiting }, (_, i) => (
                <tr key={i}>
                  {columns.map((__, c) => (
                    <td key={c}>
                      <Skeleton width="80%" />
                    </td>
                  ))}
                </tr>
              ))
            : rows.map((row, i) => (
                <tr key={keyOf(row, i)}>
                  {columns.map(({ cell, number }, c) =>
                    c === 0 ? (
                      <th key={c} scope="row">
                        {cell(row)}
                      </th>
                    ) : (
                      <td key={c} className={number ? styles.number : undefined}>
                        {cell(row)}
                      </td>
                    ),
                  )}
                </tr>
              ))}
        </tbody>
      </table>
    </Scroll>
  );
}
