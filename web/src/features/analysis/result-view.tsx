import { useQuery } from '@tanstack/react-query';
import { metricsQuery, type AnalysisResult, type PlannedTest } from '@/api';
import { Plane } from '@/charts';
import { marked, say } from '@/language';
import { Badge, Card, Notice, Table, Term } from '@/ui';
import { formatCount, formatFigure } from '@/units';
import styles from './analysis.module.css';
import { FigureView } from './figure-view';
import { cell, ReportView } from './report-view';

const kAdjusted = marked(
  'The tests of one family are corrected together, so that the error rate of the whole family stays at the level that the plan states.',
);

/** Effects with their intervals beside one another, zero marked. */
function Forest({ tests }: { readonly tests: readonly PlannedTest[] }) {
  const known = tests.flatMap((test) =>
    typeof test.size === 'number' && typeof test.ci95_low === 'number' && typeof test.ci95_high === 'number'
      ? [{ ...test, size: test.size, low: test.ci95_low, high: test.ci95_high }]
      : [],
  );
  if (known.length === 0) return null;
  const least = Math.min(0, ...known.map(({ low }) => low)),
    most = Math.max(0, ...known.map(({ high }) => high)),
    margin = (most - least || 1) * 0.06;
  return (
    <Plane
      across={{ title: say('effect with its 95 % interval'), from: least - margin, to: most + margin }}
      up={{ title: '', from: 0, to: known.length, ticks: [] }}
      height_px={70 + 34 * known.length}
      data={{
        name: say('effects'),
        columns: ['term', 'effect', 'ci95_low', 'ci95_high'],
        rows: known.map(({ term, size, low, high }) => [String(term), size, low, high]),
      }}
      summary={known
        .map(
          ({ term, size, low, high }) =>
            `${term}: ${formatFigure(size)} (${say('{low} to {high}', { low: formatFigure(low), high: formatFigure(high) })})`,
        )
        .join('; ')}
    >
      {({ x, y }) => (
        <>
          <line x1={x(0)} x2={x(0)} y1={y(0)} y2={y(known.length)} className={styles.zero} />
          {known.map(({ term, analysis, size, low, high, holds }, i) => {
            const at = y(known.length - i - 0.6);
            return (
              <g key={i} className={styles.effect} data-holds={holds === true}>
                <line x1={x(low)} x2={x(high)} y1={at} y2={at} />
                <circle cx={x(size)} cy={at} r={5} />
                <text x={x(least - margin) + 4} y={at - 9}>
                  {analysis === undefined ? term : `${term} (${analysis})`}
                </text>
              </g>
            );
          })}
        </>
      )}
    </Plane>
  );
}

function Family({ family }: { readonly family: AnalysisResult['families'][number] }) {
  return (
    <Card
      title={say('Tests: {family}', { family: say(family.name) })}
      aside={
        <Term align="end" definition={say(kAdjusted)}>
          {say('corrected by {correction}, α = {alpha}', {
            correction: family.correction,
            alpha: formatFigure(family.alpha, '', 2),
          })}
        </Term>
      }
    >
      <div className={styles.stack}>
        <Table<PlannedTest>
          caption={say('Tests of the family {family}', { family: say(family.name) })}
          rows={family.tests}
          keyOf={(_, i) => String(i)}
          empty={say('No tests.')}
          minWidth={760}
          columns={[
            {
              name: marked('Term'),
              cell: (test) => (
                <>
                  {test.term}{' '}
                  {test.analysis === undefined ? null : <span className={styles.muted}>{test.analysis}</span>}
                </>
              ),
            },
            {
              name: marked('Statistic'),
              cell: (test) =>
                test.statistic === ''
                  ? (test.note ?? '–')
                  : `${test.statistic}${typeof test.df1 === 'number' ? `(${formatFigure(test.df1)}, ${formatFigure(test.df2 ?? null)})` : typeof test.df2 === 'number' ? `(${formatFigure(test.df2)})` : ''} = ${formatFigure(test.value)}`,
            },
            {
              name: marked('Effect'),
              cell: (test) =>
                typeof test.size === 'number'
                  ? `${test.effect ?? ''} ${formatFigure(test.size)}${typeof test.ci95_low === 'number' ? ` (${say('{low} to {high}', { low: formatFigure(test.ci95_low), high: formatFigure(test.ci95_high ?? null) })})` : ''}`
                  : '–',
            },
            { name: 'p', cell: (test) => cell(test.p, 'p'), number: true },
            { name: marked('Corrected p'), cell: (test) => cell(test.p_adjusted, 'p'), number: true },
            {
              name: marked('Significant'),
              cell: (test) =>
                test.holds === undefined ? (
                  '–'
                ) : (
                  <Badge tone={test.holds ? 'good' : 'neutral'}>{test.holds ? say('yes') : say('no')}</Badge>
                ),
            },
          ]}
        />
        <Forest tests={family.tests} />
      </div>
    </Card>
  );
}

function Published({ rows }: { readonly rows: AnalysisResult['published'] }) {
  const held = rows.filter(({ printed }) => typeof printed === 'number');
  const agree = held.filter(({ agrees }) => agrees === true).length;
  return (
    <Card
      title={say('Published and recomputed values')}
      aside={
        <Badge tone={agree === held.length ? 'good' : 'warn'}>
          {say('{agree} of {count} agree', { agree: formatCount(agree), count: formatCount(held.length) })}
        </Badge>
      }
    >
      <Table<AnalysisResult['published'][number]>
        caption={say('Published values beside recomputed values')}
        rows={rows}
        keyOf={(_, i) => String(i)}
        empty={say('No published values.')}
        minWidth={760}
        columns={[
          { name: marked('Source'), cell: (one) => one.where },
          {
            name: marked('Quantity'),
            cell: (one) => (
              <>
                {one.says}
                {one.remark === '' ? null : <span className={styles.remark}>{one.remark}</span>}
              </>
            ),
          },
          { name: marked('Published'), cell: (one) => cell(one.printed), number: true },
          { name: marked('Recomputed'), cell: (one) => formatFigure(one.computed, '', 5), number: true },
          {
            name: marked('Agreement'),
            cell: (one) =>
              one.agrees === true ? (
                <Badge tone="good">{say('agrees')}</Badge>
              ) : one.agrees === false ? (
                <Badge tone="bad">{say('differs')}</Badge>
              ) : null,
          },
        ]}
      />
    </Card>
  );
}

/** Two analyses may answer the same question: then each is told by its id too. */
function titleOf(one: AnalysisResult['analyses'][number], all: AnalysisResult['analyses']): string {
  if (one.question === '') return one.id;
  const question = say(one.question);
  return all.some((other) => other.id !== one.id && other.question === one.question)
    ? `${question} (${one.id})`
    : question;
}

/** The result of an analysis: summary sentences, then tests, then each report. */
export function ResultView({ result }: { readonly result: AnalysisResult }) {
  const metrics = useQuery(metricsQuery).data?.metrics ?? [];
  return (
    <>
      <Card
        title={say('Results')}
        aside={
          result.data.simulated ? (
            <Badge tone="warn">{say('simulated data')}</Badge>
          ) : (
            <span className={styles.muted}>
              {say('{used} of {rows} rows used', {
                used: formatCount(result.data.rows_used),
                rows: formatCount(result.data.rows),
              })}
            </span>
          )
        }
      >
        {result.results.length > 0 ? (
          <ul className={styles.sentences}>
            {result.results.map((one) => (
              <li key={one}>{one}</li>
            ))}
          </ul>
        ) : (
          <p className={styles.muted}>{say('No confirmatory test was planned; exploratory results follow.')}</p>
        )}
      </Card>
      {result.families.map((family) => (
        <Family key={family.name} family={family} />
      ))}
      {result.published.length > 0 ? <Published rows={result.published} /> : null}
      {result.analyses.map((one) => (
        <Card
          key={one.id}
          title={titleOf(one, result.analyses)}
          aside={
            <span className={styles.muted}>
              <code>{one.formula === '' ? one.method : `${one.method}: ${one.formula}`}</code>
            </span>
          }
        >
          {one.error ? (
            <Notice tone="bad" title={say('This analysis failed.')}>
              {one.error}
            </Notice>
          ) : one.report ? (
            <div className={styles.stack}>
              {one.figures.length > 0 ? <FigureView figures={one.figures} metrics={metrics} /> : null}
              <ReportView report={one.report} />
            </div>
          ) : null}
        </Card>
      ))}
      <Card title={say('Methods text for publication')}>
        <p className={styles.methods}>{result.methods.join(' ')}</p>
      </Card>
    </>
  );
}
