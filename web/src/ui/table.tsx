import { Fragment, type ReactNode } from 'react';
import { say } from '@/language';
import { Scroll } from './scroll';
import { Skeleton } from './skeleton';
import styles from './table.module.css';

export interface Column<Row> {
  readonly name: ReactNode;
  readonly cell: (row: Row) => ReactNode;
  readonly number?: boolean;
  /** How the rows are sorted by this column, if they are. */
  readonly sorted?: 'ascending' | 'descending' | undefined;
}

export interface TableProps<Row> {
  readonly caption: string;
  readonly columns: readonly Column<Row>[];
  /** undefined while they are on their way. */
  readonly rows: readonly Row[] | undefined;
  readonly keyOf: (row: Row, index: number) => string;
  readonly empty: ReactNode;
  readonly minWidth?: number | undefined;
  /** How many rows hold the place of those on their way. */
  readonly waiting?: number | undefined;
  readonly className?: string | undefined;
  /** What stands below a row, over its whole width. */
  readonly detail?: ((row: Row) => ReactNode) | undefined;
}

/** A plain table: its first column names the row. */
export function Table<Row>({
  caption,
  columns,
  rows,
  keyOf,
  empty,
  minWidth,
  waiting = 4,
  className,
  detail,
}: TableProps<Row>) {
  if (rows?.length === 0) return <p className={styles.empty}>{empty}</p>;
  return (
    <Scroll label={caption} className={className}>
      {/* Another table than the one that held its place: columns take their widths from the rows, and would jump. */}
      <table
        key={rows === undefined ? 'waiting' : 'here'}
        className={styles.table}
        aria-busy={rows === undefined}
        style={minWidth === undefined ? undefined : { minWidth }}
      >
        <caption className="hidden-visually">{caption}</caption>
        <thead>
          <tr>
            {columns.map(({ name, number, sorted }, i) => (
              <th key={i} scope="col" className={number ? styles.number : undefined} aria-sort={sorted}>
                {typeof name === 'string' ? say(name) : name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows === undefined
            ? Array.from({ length: waiting }, (_, i) => (
                <tr key={i}>
                  {columns.map((__, c) => (
                    <td key={c}>
                      <Skeleton width="80%" />
                    </td>
                  ))}
                </tr>
              ))
            : rows.map((row, i) => {
                const more = detail?.(row);
                return (
                  <Fragment key={keyOf(row, i)}>
                    <tr>
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
                    {more ? (
                      <tr>
                        <td colSpan={columns.length} className={styles.detail}>
                          {more}
                        </td>
                      </tr>
                    ) : null}
                  </Fragment>
                );
              })}
        </tbody>
      </table>
    </Scroll>
  );
}
