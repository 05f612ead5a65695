import {
  columnFilteringFeature,
  createFilteredRowModel,
  createSortedRowModel,
  globalFilteringFeature,
  rowSortingFeature,
  sortFn_alphanumeric,
  sortFn_text,
  tableFeatures,
  useTable,
} from '@tanstack/react-table';
import type { ColumnDef } from '@tanstack/react-table';
import type { ReactNode } from 'react';
import { say } from '@/language';
import { formatCount } from '@/units';
import { Button } from './button';
import styles from './data-table.module.css';
import { Field } from './field';
import { Table, type Column, type TableProps } from './table';
import { useTableState } from './table-state';

/** What rows are sorted by: text, a number, or nothing, which comes last. */
type Value = string | number | boolean | null | undefined;

export interface DataColumn<Row> extends Omit<Column<Row>, 'sorted'> {
  /** What the rows are sorted by; a column without it has no button. */
  readonly by?: (row: Row) => Value;
  /** The column's name in plain text, where `name` is more than text. */
  readonly title?: string;
}

interface Props<Row> extends Omit<TableProps<Row>, 'columns'> {
  readonly columns: readonly DataColumn<Row>[];
  /** The order in which the rows come, said until a column sorts them. */
  readonly order?: string;
  /** A field that narrows the rows to those whose text contains what is typed. */
  readonly filter?: { readonly label: string; readonly text: (row: Row) => string };
  readonly pageSize?: number;
  /** Keeps filter, order and page in the address; what their names begin with: "" for the only such table of a page. */
  readonly address?: string;
  /** The server hands out rows part by part, so there are no pages here; true: it has more of them. */
  readonly partial?: boolean;
  /** Stands below in place of the buttons for the pages. */
  readonly below?: ReactNode;
}

interface Line<Row> {
  readonly row: Row;
  readonly text: string;
  readonly values: readonly (Value | undefined)[];
}

const features = tableFeatures({
  rowSortingFeature,
  columnFilteringFeature,
  globalFilteringFeature,
  sortedRowModel: createSortedRowModel(),
  filteredRowModel: createFilteredRowModel(),
  sortFns: { alphanumeric: sortFn_alphanumeric, text: sortFn_text },
});

const kSigns = { ascending: '▲', descending: '▼', none: '↕' } as const;

const titleOf = <Row,>({ title, name }: Pick<DataColumn<Row>, 'name' | 'title'>) =>
  say(title ?? (typeof name === 'string' ? name : ''));

/** A column's name as the button that sorts by it; where the name is a term with its definition, the button stands beside it. */
export function SortHead<Row>({
  column,
  sorted,
  onPress,
}: {
  readonly column: Pick<DataColumn<Row>, 'name' | 'title'>;
  readonly sorted: Column<Row>['sorted'];
  readonly onPress: () => void;
}) {
  const plain = typeof column.name === 'string';
  return (
    <>
      {plain ? null : column.name}
      <button
        type="button"
        className={styles.sort}
        onClick={onPress}
        aria-label={plain ? undefined : say('Sort by {column}', { column: titleOf(column) })}
      >
        {plain ? titleOf({ name: column.name }) : null}
        <span aria-hidden="true" className={styles.sign}>
          {kSigns[sorted ?? 'none']}
        </span>
      </button>
    </>
  );
}

export function Pages({
  label,
  page,
  size,
  of,
  onPage,
}: {
  readonly label: string;
  readonly page: number;
  readonly size: number;
  readonly of: number;
  readonly onPage: (page: number) => void;
}) {
  const end = (page + 1) * size;
  return (
    <nav className={styles.pages} aria-label={label}>
      <Button disabled={page === 0} onClick={() => onPage(page - 1)}>
        {say('Previous')}
      </Button>
      <span role="status">
        {say('{first}–{last} of {all}', {
          first: formatCount(page * size + 1),
          last: formatCount(Math.min(end, of)),
          all: formatCount(of),
        })}
      </span>
      <Button disabled={end >= of} onClick={() => onPage(page + 1)}>
        {say('Next')}
      </Button>
    </nav>
  );
}

/** A table with many rows: sorted by its headers, narrowed by a text, shown page by page. */
export function DataTable<Row>({
  columns,
  rows,
  caption,
  order,
  filter,
  pageSize: most = 50,
  address,
  partial,
  below,
  empty,
  ...rest
}: Props<Row>) {
  const [state, setState] = useTableState(address);
  const { typed, sort, page } = state;
  const pageSize = partial === undefined ? most : Number.MAX_SAFE_INTEGER;
  // The lines hold the values of now: what a column sorts by may come from another answer than the rows.
  const lines = (rows ?? []).map((row) => ({
    row,
    text: filter?.text(row) ?? '',
    values: columns.map(({ by }) => by?.(row) ?? undefined),
  }));
  const table = useTable<typeof features, Line<Row>>({
    features,
    data: lines,
    columns: [
      ...columns.map(({ by }, i): ColumnDef<typeof features, Line<Row>> => ({
        id: String(i),
        accessorFn: ({ values }) => values[i],
        enableSorting: by !== undefined,
        enableGlobalFilter: false,
        sortUndefined: 'last',
      })),
      { id: 'text', accessorFn: ({ text }) => text },
    ],
    state: {
      globalFilter: typed.trim(),
      sorting: sort && sort.column < columns.length ? [{ id: String(sort.column), desc: sort.down }] : [],
    },
    onSortingChange: (change) => {
      const was = sort ? [{ id: String(sort.column), desc: sort.down }] : [];
      const [next] = typeof change === 'function' ? change(was) : change;
      setState({ ...state, sort: next ? { column: Number(next.id), down: next.desc } : null, page: 0 });
    },
    autoResetAll: false,
  });
  const matching = table.getRowModel().rows;
  const found = matching.length;
  const last = Math.max(Math.ceil(found / pageSize) - 1, 0);
  const shown = Math.min(page, last); // rows may have gone since the page was turned
  const sortedBy = sort ? columns[sort.column] : undefined;

  const headed = columns.map((column, i): Column<Row> => {
    if (!column.by) return column;
    const sorted = column !== sortedBy ? undefined : sort?.down ? 'descending' : 'ascending';
    const press = () => table.getColumn(String(i))?.toggleSorting();
    return { ...column, sorted, name: <SortHead column={column} sorted={sorted} onPress={press} /> };
  });
  const ordered = sortedBy ? say('sorted by {column}', { column: titleOf(sortedBy) }) : order;
  return (
    <div className={styles.stack}>
      {filter ? (
        <div className={styles.tools}>
          <span role="status">
            {typed === '' ? '' : say('{found} of {all}', { found: formatCount(found), all: formatCount(lines.length) })}
          </span>
          <Field
            label={<span className="hidden-visually">{filter.label}</span>}
            placeholder={filter.label}
            type="search"
            value={typed}
            onChange={(event) => setState({ ...state, typed: event.target.value, page: 0 })}
          />
        </div>
      ) : null}
      {partial && (typed !== '' || sortedBy) ? (
        <p className={styles.muted}>{say('Only the rows loaded so far are searched and sorted.')}</p>
      ) : null}
      <Table<Row>
        {...rest}
        columns={headed}
        caption={ordered === undefined ? caption : `${caption}, ${ordered}`}
        rows={rows && matching.slice(shown * pageSize, (shown + 1) * pageSize).map(({ original }) => original.row)}
        empty={rows?.length === 0 ? empty : say('No rows match.')}
      />
      {below ??
        (last > 0 ? (
          <Pages
            label={say('Pages: {caption}', { caption })}
            page={shown}
            size={pageSize}
            of={found}
            onPage={(next) => setState({ ...state, page: next })}
          />
        ) : null)}
    </div>
  );
}
