import type { Diagnosis } from '@/api';
import { Card, Table } from '@/ui';
import { formatFigure, formatShare, share } from '@/units';
import styles from './lab.module.css';
import { joined } from './names';
import { tableRows, type TableRow } from './unknown-function';

type Discovery = NonNullable<Diagnosis['discovery']>;
type Unknown = NonNullable<Discovery['unknown']>;
type Term = Discovery['proposals'][number]['terms'][number];

function EffectFile({ effect, name }: { readonly effect: Term['effect']; readonly name: string }) {
  return (
    <a download={`${name}.json`} href={`data:application/json,${encodeURIComponent(JSON.stringify(effect))}`}>
      Custom effect
    </a>
  );
}

function Proposals({ discovery, unit }: { readonly discovery: Discovery; readonly unit: string }) {
  if (discovery.proposals.length === 0)
    return discovery.remark === '' ? null : <p>No formula is proposed: {discovery.remark}.</p>;
  return (
    <Table
      caption="Proposed formulas"
      rows={discovery.proposals}
      keyOf={({ formula }) => formula}
      empty="No formulas."
      columns={[
        { name: 'Formula', cell: ({ formula }) => <code>{formula}</code> },
        { name: 'Resembles', cell: ({ terms }) => joined(terms.map(({ resembles }) => resembles)) },
        { name: 'Held-out error', number: true, cell: ({ held_out_rmse }) => formatFigure(held_out_rmse, unit) },
        {
          name: 'Probability',
          number: true,
          cell: ({ probability }) => (probability === null ? '–' : formatShare(share(probability))),
        },
        {
          name: 'Files',
          cell: ({ terms }) =>
            terms.map(({ formula, effect }, k) => (
              <p key={formula}>
                <EffectFile effect={effect} name={`proposal-${k + 1}`} />
              </p>
            )),
        },
      ]}
    />
  );
}

/** The force at the knots: of one signal a row for each knot, of two the second across. */
function UnknownTable({ unknown }: { readonly unknown: Unknown }) {
  const [first, second] = unknown.signals;
  const across = unknown.knots[1];
  const heading = (k: number) => `${unknown.signals[k] ?? ''}, ${unknown.units[k] ?? ''}`;
  return (
    <Table<TableRow>
      caption={`Force as a function of ${joined([first, second].filter((one) => one !== undefined))}`}
      rows={tableRows(unknown)}
      keyOf={({ at }, k) => `${k} ${at ?? ''}`}
      empty="No values."
      columns={[
        { name: heading(0), cell: ({ at }) => formatFigure(at, '') },
        ...(across ?? [null]).map((knot, k) => ({
          name: knot === null ? 'Force' : `${heading(1)} = ${formatFigure(knot, '')}`,
          number: true,
          cell: ({ force_N }: TableRow) => formatFigure(force_N[k] ?? null, 'N'),
        })),
      ]}
    />
  );
}

/** What no effect of the catalogue explains: formulas that were found, and the function without a formula as a table. */
export function DiscoveryCard({ diagnosis, unit }: { readonly diagnosis: Diagnosis; readonly unit: string }) {
  const { discovery } = diagnosis;
  if (!discovery) return null;
  const { unknown, unknown_probability } = discovery;
  return (
    <Card title="What no effect of the catalogue explains">
      <div className={styles.stack}>
        <Proposals discovery={discovery} unit={unit} />
        {unknown ? (
          <>
            <p className={styles.readable} data-part="unknown-function">
              Without a formula, a function of {joined(unknown.signals)} explains most of what remains. It is a table,
              not a law.{' '}
              {unknown_probability === null
                ? ''
                : `The probability that none of the formulas tried is right is ${formatShare(share(unknown_probability))}. `}
              {unknown.effect ? <EffectFile effect={unknown.effect} name="unknown-function" /> : null}
            </p>
            <UnknownTable unknown={unknown} />
          </>
        ) : null}
      </div>
    </Card>
  );
}
