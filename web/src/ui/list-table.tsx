import type { ReactNode } from 'react';
import { say } from '@/language';
import { formatCount } from '@/units';
import { Button } from './button';
import { SortHead } from './data-table';
import { Field } from './field';
import type { Asked, ListState } from './list-state';
import styles from './list-table.module.css';
import { SavedViewsBar, type SavedViews } from './saved-views';
import { Table, type Column, type TableProps } from './table';

export interface ListColumn<Row> extends Omit<Column<Row>, 'sorted'> {
  /** The server's word for this order; a column without it has no button. */
  readonly sort?: string;
  /** The usual direction of this order, where it is not ascending. */
  readonly falls?: boolean;
}

/** Its words may be marked for translation. */
export interface ListFilter {
  /** The server's word. */
  readonly name: string;
  readonly label: string;
  readonly choices: readonly { readonly value: string; readonly text: string }[];
}

/** Where the rows are in their list. */
export interface ListPage {
  readonly total: number;
  readonly more_than_total: boolean;
  readonly next: string | null;
  readonly previous: string | null;
}

interface Props<Row> extends Omit<TableProps<Row>, 'columns'> {
  readonly columns: readonly ListColumn<Row>[];
  readonly list: Pick<ListState, 'asked' | 'change' | 'open' | 'search'>;
  /** undefined while it is on its way. */
  readonly page: ListPage | undefined;
  /** The order of a list of which none was asked. */
  readonly usual: string;
  /** Label of the search: "Find by person, case or station". */
  readonly searchLabel: string;
  readonly filters?: readonly ListFilter[];
  readonly views: SavedViews;
  /** Stands behind the number of rows. */
  readonly remark?: string;
}

function Filters({
  filters,
  asked,
  change,
}: {
  filters: readonly ListFilter[];
  asked: Asked;
  change: (next: Asked) => void;
}) {
  return filters.map(({ name, label, choices }) => (
    <div key={name} className={styles.chips} role="group" aria-label={say(label)}>
      <span className={styles.label} aria-hidden="true">
        {say(label)}
      </span>
      {choices.map(({ value, text }) => {
        const on = asked[name] === value;
        return (
          <Button key={value} pressed={on} onClick={() => change({ [name]: on ? undefined : value })}>
            {say(text)}
          </Button>
        );
      })}
    </div>
  ));
}

function headed<Row>(column: ListColumn<Row>, usual: string, asked: Asked, change: (next: Asked) => void): Column<Row> {
  const { sort, falls } = column;
  if (sort === undefined) return column;
  const natural = falls ? 'descending' : 'ascending';
  const sorted = (asked.sort ?? usual) === sort ? (asked.order ?? natural) : undefined;
  const turned = sorted === 'ascending' ? 'descending' : 'ascending';
  const press = () => change({ sort, order: sorted === undefined ? undefined : turned });
  return { ...column, sorted, name: <SortHead column={column} sorted={sorted} onPress={press} /> };
}

const countText = ({ total, more_than_total }: ListPage, narrowed: boolean): string =>
  narrowed
    ? say('{count} found', { count: `${formatCount(total)}${more_than_total ? '+' : ''}` })
    : say('{count} in all', { count: `${formatCount(total)}${more_than_total ? '+' : ''}` });

/** A list that the server searches, sorts and cuts into pages; what is shown is in the address. */
export function ListTable<Row>({
  columns,
  list: { asked, change, open, search },
  page,
  usual,
  searchLabel,
  filters = [],
  views,
  remark = '',
  empty,
  ...rest
}: Props<Row>) {
  const narrowed = (asked.search ?? '') !== '' || filters.some(({ name }) => asked[name] !== undefined);
  const turned = asked.cursor !== undefined;
  let nothing: ReactNode = empty;
  if (narrowed) nothing = say('No rows match.');
  if (turned) nothing = say('No rows on this page.');
  return (
    <div className={styles.stack}>
      <div className={styles.tools}>
        <div className={styles.find}>
          <Field
            label={searchLabel}
            type="search"
            value={asked.search ?? ''}
            maxLength={100}
            onChange={(event) => change({ search: event.target.value })}
          />
        </div>
        <Filters filters={filters} asked={asked} change={change} />
      </div>
      <SavedViewsBar {...views} here={search} onOpen={open} />
      <p role="status" className={styles.count}>
        {page === undefined ? '' : `${countText(page, narrowed)}${remark}`}
      </p>
      <Table<Row> {...rest} columns={columns.map((column) => headed(column, usual, asked, change))} empty={nothing} />
      {turned || page?.next ? (
        <nav className={styles.pages} aria-label={say('Pages: {caption}', { caption: rest.caption })}>
          <Button disabled={!turned} onClick={() => change({})}>
            {say('First')}
          </Button>
          <Button disabled={!page?.previous} onClick={() => change({ cursor: page?.previous ?? undefined })}>
            {say('Previous')}
          </Button>
          <Button disabled={!page?.next} onClick={() => change({ cursor: page?.next ?? undefined })}>
            {say('Next')}
          </Button>
        </nav>
      ) : null}
    </div>
  );
}
