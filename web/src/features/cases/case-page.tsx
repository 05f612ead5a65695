import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { ApiError, caseQuery, casesQuery, caseTruthQuery, previewQuery, type CaseTruth } from '@/api';
import { PlanView } from '@/charts';
import { say } from '@/language';
import { Button, Card, Facts, Notice, Skeleton, usePalette, useTitle, wallName } from '@/ui';
import { formatDateTime, formatLength, metre } from '@/units';
import styles from './cases.module.css';
import { CaseCertificate, FeltSign } from './certificate';

function truthFacts(truth: CaseTruth): { name: string; value: string }[] {
  if (truth.breached === null) return [{ name: say('Breach'), value: say('none') }];
  return [
    { name: say('Breach'), value: wallName(truth.breached) },
    { name: say('Wall thickness'), value: formatLength(metre(truth.wall_thickness_m)) },
    { name: say('Depth beyond the bone'), value: formatLength(metre(truth.breach_depth_m)) },
  ];
}

/** The truth is shown on request only: a trainee may be looking at the same screen. */
function Truth({ id }: { readonly id: string }) {
  const [shown, setShown] = useState(false);
  const query = useQuery({ ...caseTruthQuery(id), enabled: shown });
  const refused = query.error instanceof ApiError && query.error.code === 'forbidden';
  return (
    <Card title={say('Truth')}>
      <div className={styles.truth}>
        {!shown ? <Button onClick={() => setShown(true)}>{say('Show the breached wall')}</Button> : null}
        {shown && query.data ? (
          <>
            <Facts facts={truthFacts(query.data)} />
            <Button look="quiet" onClick={() => setShown(false)}>
              {say('Hide')}
            </Button>
          </>
        ) : null}
        {shown && query.isPending ? <Skeleton height="40px" /> : null}
        {shown && query.isError ? (
          <Notice
            tone={refused ? 'warn' : 'bad'}
            title={
              refused
                ? say('Only faculty and administrators can see the truth.')
                : say('The truth could not be loaded.')
            }
          >
            {query.error.message}
          </Notice>
        ) : null}
      </div>
    </Card>
  );
}

/** One case: what it is made of, its tract in the bone, and the truth for those who may know it. */
export function CasePage({ id }: { readonly id: string }) {
  const query = useQuery(caseQuery(id));
  const preview = useQuery(previewQuery(id));
  const palette = usePalette();
  const found = query.data;
  const summary = useQuery(casesQuery({ search: id })).data?.cases.find((one) => one.id === id);
  useTitle(found?.title ?? say('Case'));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/cases">← {say('Cases')}</Link>
      </p>
      {query.isError ? (
        <Notice tone="bad" title={say('The case could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? (
        <div role="status">
          <span className="hidden-visually">{say('Loading the case')}</span>
          <Skeleton height="480px" />
        </div>
      ) : null}
      {found ? (
        <>
          <h1>{found.title}</h1>
          <Facts
            facts={[
              { name: say('Source'), value: found.source },
              { name: say('Created'), value: formatDateTime(found.made_utc_us) },
              {
                name: say('Channel'),
                value: found.channel === 'planned' ? say('trainee drills, then palpates') : say('pre-drilled'),
              },
              {
                name: say('Bone'),
                value: found.preparation === 'filled' ? say('filled') : say('published: marrow is not felt'),
              },
              {
                name: say('Tract'),
                value: say('{length} long, {width} wide', {
                  length: formatLength(found.tract.length_m),
                  width: formatLength(metre(2 * found.tract.radius_m)),
                }),
              },
            ]}
          />
          {summary ? (
            <p>
              <FeltSign {...summary} />
            </p>
          ) : null}
          <div className={styles.pair}>
            <Card title={say('Tract in the bone')}>
              {preview.isError ? (
                <Notice
                  tone="warn"
                  title={say('The bone could not be loaded. The view does not show it.')}
                  onRetry={() => void preview.refetch()}
                >
                  {preview.error.message}
                </Notice>
              ) : null}
              {preview.isPending ? (
                <Skeleton height="444px" />
              ) : (
                <PlanView
                  tract={found.tract}
                  breach={null}
                  bone={preview.data ?? null}
                  palette={palette}
                  summary={say('The tract and the surrounding bone.')}
                  button={(label, text, press, pressed) => (
                    <Button label={label} onClick={press} {...(pressed === undefined ? {} : { pressed })}>
                      {text}
                    </Button>
                  )}
                />
              )}
            </Card>
            <Truth id={id} />
          </div>
          {found.channel === 'planned' ? null : <CaseCertificate id={id} length_m={found.tract.length_m} />}
        </>
      ) : null}
    </div>
  );
}
