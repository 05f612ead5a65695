import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, useRef } from 'react';
import { Link } from 'wouter';
import {
  allCasesQuery,
  casesAsked,
  casesQuery,
  makingsQuery,
  retireCase,
  sessionQuery,
  sourceVolumesQuery,
  useSavedViews,
  type CaseSummary,
  type Making,
  type SourceVolume,
} from '@/api';
import { marked, say } from '@/language';
import {
  Badge,
  Button,
  Card,
  DataTable,
  ListTable,
  Notice,
  Progress,
  Table,
  useList,
  useTitle,
  type ListFilter,
} from '@/ui';
import { formatCount, formatDateTime, formatShare, share } from '@/units';
import styles from './cases.module.css';
import { FeltSign } from './certificate';

function Volumes() {
  const query = useQuery(sourceVolumesQuery);
  const released = query.data?.volumes.filter(({ state }) => state === 'released');
  const held = query.data?.volumes.filter(({ state }) => state === 'held').length ?? 0;
  return (
    <Card title={say('Create a case from a volume')}>
      {query.isError ? (
        <Notice tone="bad" title={say('The volumes could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : (
        <div className={styles.stack}>
          <DataTable<SourceVolume>
            caption={say('Released volumes')}
            rows={released}
            keyOf={({ id }) => id}
            empty={say(
              'No released volumes yet. An administrator or the programme director reviews every imported volume before its release.',
            )}
            columns={[
              {
                name: say('Volume'),
                by: (one) => one.name,
                cell: (one) => <Link href={`/cases/new/${one.id}`}>{one.name}</Link>,
              },
              { name: say('Source'), by: (one) => one.source, cell: (one) => one.source },
              { name: say('Voxels'), cell: (one) => one.dims.map(formatCount).join(' × '), number: true },
              { name: say('Imported'), by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
            ]}
          />
          {held > 0 ? (
            <p className={styles.muted}>
              {say('{held, plural, one {# volume is} other {# volumes are}} waiting for review.', { held })}
            </p>
          ) : null}
        </div>
      )}
    </Card>
  );
}

function CasesInPreparation() {
  const client = useQueryClient();
  const query = useQuery(makingsQuery);
  const shown = query.data?.makings.filter(({ state }) => state !== 'done') ?? [];
  const done = query.data?.makings.filter(({ state }) => state === 'done').length;
  const before = useRef(done);
  useEffect(() => {
    if (before.current !== undefined && done !== before.current)
      void client.invalidateQueries({ queryKey: allCasesQuery.queryKey });
    before.current = done;
  }, [done, client]);
  if (shown.length === 0) return null;
  return (
    <Card title={say('Cases in preparation')}>
      <Table<Making>
        caption={say('Cases in preparation')}
        rows={shown}
        keyOf={({ id }) => id}
        empty=""
        columns={[
          { name: say('Case'), cell: (one) => one.title },
          {
            name: say('State'),
            cell: (one) =>
              one.state === 'failed' ? (
                <span>
                  <Badge tone="bad">{say('failed')}</Badge> {one.error}{' '}
                  <Link href={`/cases/new/${one.volume}`}>{say('Try again')}</Link>
                </span>
              ) : (
                <span className={styles.going}>
                  <Progress done={one.share} of={1} label={say('Preparing {title}', { title: one.title })} />
                  <span>{formatShare(share(one.share))}</span>
                  <span>{one.state === 'queued' ? say('queued') : one.phase}</span>
                </span>
              ),
          },
          {
            name: say('Requested'),
            cell: (one) => say('{time} by {name}', { time: formatDateTime(one.made_utc_us), name: one.made_by }),
          },
        ]}
      />
    </Card>
  );
}

const kFilters: readonly ListFilter[] = [
  {
    name: 'state',
    label: marked('State'),
    choices: [
      { value: 'available', text: marked('available') },
      { value: 'retired', text: marked('retired') },
    ],
  },
  {
    name: 'channel',
    label: marked('Channel'),
    choices: [
      { value: 'drilled', text: marked('drilled') },
      { value: 'planned', text: marked('trainee drills') },
    ],
  },
];

/** Cases of the palpation rig: volumes to create them from, cases in preparation, all cases. */
export function CasesPage() {
  useTitle(say('Cases'));
  const client = useQueryClient();
  const list = useList(casesAsked);
  const query = useQuery(casesQuery(list.query));
  const views = useSavedViews('cases');
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const may = role === 'admin' || role === 'faculty';
  const retired = useMutation({
    mutationFn: ({ one, away }: { one: CaseSummary; away: boolean }) => retireCase(one.id, away),
    onSuccess: () => client.invalidateQueries({ queryKey: allCasesQuery.queryKey }),
  });
  const last = retired.data === undefined && retired.isSuccess ? retired.variables : null;
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Cases')}</h1>
        <p className={styles.lead}>
          {say(
            'A case is a patient’s bone with a drilled channel. The truth (which wall is breached, and where) is stored separately; stations receive the case without it. In cases without a pre-drilled channel, the trainee drills the channel and then palpates it.',
          )}
        </p>
      </div>
      {may ? <Volumes /> : null}
      {may ? <CasesInPreparation /> : null}
      {query.isError ? (
        <Notice tone="bad" title={say('The cases could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : (
        <Card title={say('Cases')} aside={may ? <Link href="/assignments/new">{say('Assign cases')}</Link> : undefined}>
          <div className={styles.stack}>
            <ListTable<CaseSummary>
              caption={say('Cases')}
              list={list}
              page={query.data}
              views={views}
              usual="published"
              searchLabel={say('Find by case or source')}
              filters={kFilters}
              rows={query.data?.cases}
              keyOf={({ id }) => id}
              empty={say('No cases yet. Create one from a volume.')}
              minWidth={640}
              columns={[
                {
                  name: say('Case'),
                  sort: 'title',
                  cell: (one) => <Link href={`/cases/${one.id}`}>{one.title}</Link>,
                },
                { name: say('Source'), sort: 'source', cell: (one) => one.source },
                { name: say('Created'), sort: 'made', falls: true, cell: (one) => formatDateTime(one.made_utc_us) },
                { name: say('Trials'), cell: (one) => formatCount(one.trials), number: true },
                {
                  name: say('State'),
                  cell: (one) =>
                    one.retired ? (
                      <Badge>{say('retired')}</Badge>
                    ) : (
                      <>
                        <Badge tone="good">{say('available')}</Badge> <FeltSign {...one} />
                        {one.planned ? (
                          <>
                            {' '}
                            <Badge>{say('trainee drills')}</Badge>
                          </>
                        ) : null}
                      </>
                    ),
                },
                {
                  name: <span className="hidden-visually">{say('Actions')}</span>,
                  cell: (one) =>
                    may ? (
                      <Button
                        look="quiet"
                        label={`${one.retired ? say('Restore') : say('Retire')}: ${one.title}`}
                        disabled={retired.isPending}
                        onClick={() => retired.mutate({ one, away: !one.retired })}
                      >
                        {one.retired ? say('Restore') : say('Retire')}
                      </Button>
                    ) : null,
                },
              ]}
            />
            <p className={styles.message} role="status">
              {last ? (
                <>
                  {last.away
                    ? say('{title} is retired; existing assignments continue.', { title: last.one.title })
                    : say('{title} is available again.', { title: last.one.title })}{' '}
                  <Button look="quiet" onClick={() => retired.mutate({ one: last.one, away: !last.away })}>
                    {say('Undo')}
                  </Button>
                </>
              ) : null}
              {retired.isError ? say('The action failed: {message}', { message: retired.error.message }) : null}
            </p>
          </div>
        </Card>
      )}
    </div>
  );
}
