import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import {
  ApiError,
  caseCertificateQuery,
  kFeltSigns,
  plannedCertificateQuery,
  type CaseSummary,
  type Certificate,
  type TractRequest,
  type WallCertificate,
} from '@/api';
import { kSides, WallBands, type SideBands } from '@/charts';
import { say } from '@/language';
import { Badge, Button, Card, Notice, Skeleton, Table, wallName } from '@/ui';
import { formatFigure, formatLength, formatShare, kNone, share, type Metre } from '@/units';
import styles from './cases.module.css';

/** The d′ that a side wall must reach, as the server's certificate has it. */
const kLeastSide = 2.5;
/** The share of right answers that it must be foretold, as the server has it. */
const kLeastForetold_percent = 75;

/** The lesser of K and B; K of the end. */
const dPrimeOf = (k: number | null, b: number | null) => (k === null ? b : b === null ? k : Math.min(k, b));
const number = (value: number | null) => formatFigure(value, '', 2);

const bandsOf = (walls: readonly WallCertificate[]): SideBands[] =>
  walls.flatMap(({ wall, places }) => {
    const side = kSides.find((one) => one === wall);
    return side && places
      ? [
          {
            side,
            at_m: places.at_m,
            dPrime: places.at_m.map((_, n) => dPrimeOf(places.k[n] ?? null, places.b[n] ?? null)),
          },
        ]
      : [];
  });

/** Whether the breaches of a case can be told by feel; nothing of one that is still to be drilled. */
export function FeltSign({ felt, planned }: Pick<CaseSummary, 'felt' | 'planned'>) {
  if (planned) return null;
  const { tone, text } = kFeltSigns[felt];
  return <Badge tone={tone}>{say(text)}</Badge>;
}

/** What an ideal observer can tell of each wall. */
export function CertificateView({
  certificate,
  length_m,
}: {
  readonly certificate: Certificate;
  readonly length_m: Metre;
}) {
  const bands = bandsOf(certificate.walls);
  return (
    <div className={styles.stack}>
      {bands.length > 0 ? <WallBands bands={bands} length_m={length_m} least={kLeastSide} /> : null}
      <Table
        caption={say('What can be told of a breach of each wall')}
        rows={certificate.walls}
        keyOf={({ wall }) => wall}
        empty=""
        minWidth={420}
        columns={[
          { name: say('Wall'), cell: ({ wall }) => wallName(wall) },
          {
            name: say('Breach'),
            cell: ({ passes, why_not }) =>
              why_not === null ? (
                <Badge tone={passes ? 'good' : 'bad'}>{passes ? say('can be felt') : say('cannot be felt')}</Badge>
              ) : (
                why_not
              ),
          },
          { name: say('Depth'), cell: ({ at_m }) => (at_m === null ? kNone : formatLength(at_m)), number: true },
          { name: 'K', cell: ({ k }) => number(k), number: true },
          { name: 'B', cell: ({ b }) => number(b), number: true },
          { name: 'FA', cell: ({ fa }) => number(fa), number: true },
          {
            name: say('Right'),
            cell: ({ foretold }) => (foretold === undefined ? kNone : formatShare(share(foretold))),
            number: true,
          },
        ]}
      />
      <p className={styles.muted}>
        {say(
          'K: d′ of the breach against the same place when it is whole. B: against all other places of this tract. FA: of the whole place that feels most like a breach. A side wall needs K and B of {least} and B at least 0.5 over FA; the end needs K of 2. Upper bounds, of an ideal observer. Right: the share of right answers that is foretold of a hand which presses with the tip; a wall needs {foretold} %.',
          { least: kLeastSide, foretold: kLeastForetold_percent },
        )}
      </p>
    </div>
  );
}

/** On request only: a trainee may be looking at the same screen. */
export function CaseCertificate({ id, length_m }: { readonly id: string; readonly length_m: Metre }) {
  const [shown, setShown] = useState(false);
  const query = useQuery({ ...caseCertificateQuery(id), enabled: shown });
  const none = query.error instanceof ApiError && query.error.code === 'not_found';
  return (
    <Card title={say('What can be felt')}>
      <div className={styles.truth}>
        <Button look={shown ? 'quiet' : 'plain'} onClick={() => setShown(!shown)}>
          {shown ? say('Hide') : say('Show the certificate')}
        </Button>
        {shown && query.isPending ? <Skeleton height="300px" /> : null}
        {shown && query.data ? <CertificateView certificate={query.data} length_m={length_m} /> : null}
        {shown && query.isError ? (
          <Notice
            tone="warn"
            title={none ? say('This case has no certificate.') : say('The certificate could not be loaded.')}
          >
            {query.error.message}
          </Notice>
        ) : null}
      </div>
    </Card>
  );
}

/** The certificate that a plan would have: one place of each wall at once, every place when it stays as it is. */
export function PlannedCertificate({
  volume,
  request,
  length_m,
}: {
  readonly volume: string;
  readonly request: TractRequest | null;
  readonly length_m: Metre;
}) {
  const asked = request?.channel === 'planned' ? null : request && { ...request, breach: null };
  const first = useQuery(plannedCertificateQuery(volume, asked, 'first'));
  const whole = useQuery(plannedCertificateQuery(volume, first.isSuccess ? asked : null, 'whole'));
  const found = whole.data ?? first.data;
  const error = first.error ?? whole.error;
  if (!asked)
    return <p className={styles.muted}>{say('Without a pre-drilled channel there is nothing to feel yet.')}</p>;
  return (
    <div className={styles.stack} data-part="certificate" role="status">
      {found && !whole.data ? (
        <p className={styles.muted}>{say('One place of each wall so far; trying every place…')}</p>
      ) : null}
      {!found && !error ? <p className={styles.muted}>{say('Palpating…')}</p> : null}
      {error ? (
        <Notice tone="warn" title={say('The plan could not be palpated.')}>
          {error.message}
        </Notice>
      ) : null}
      {found && found.problem !== '' ? <p className={styles.problem}>{found.problem}</p> : null}
      {found && found.warning !== '' ? <p className={styles.problem}>{found.warning}</p> : null}
      {found?.certificate ? <CertificateView certificate={found.certificate} length_m={length_m} /> : null}
    </div>
  );
}
