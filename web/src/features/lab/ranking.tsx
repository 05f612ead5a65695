import { useState } from 'react';
import { Link } from 'wouter';
import type { Effect, Ranked } from '@/api';
import { Badge, Bar, Button, Scroll, Term } from '@/ui';
import { formatFigure, formatShare, share } from '@/units';
import { kHeldOutMeaning } from './error-steps';
import styles from './lab.module.css';
import { effectName, kEffectKinds } from './names';

interface Props {
  readonly ranking: readonly Ranked[];
  readonly effects: readonly Effect[];
  readonly unit: string;
  /** The error without any effect. */
  readonly without: number | null;
  readonly addressToTry: (id: string) => string;
}

const kFew = 6;

function Row({
  ranked,
  effect,
  worst,
  unit,
  addressToTry,
}: {
  readonly ranked: Ranked;
  readonly effect: Effect | undefined;
  readonly worst: number;
  readonly unit: string;
  readonly addressToTry: (id: string) => string;
}) {
  const kind = effect ? kEffectKinds[effect.kind] : null;
  return (
    <tr>
      <th scope="row">
        {effectName(ranked.id)}
        {effect ? (
          <span className={styles.law}>
            <code>{effect.equation}</code>
            <span className={styles.muted}>{effect.summary}</span>
          </span>
        ) : null}
      </th>
      <td>{kind ? <Term definition={kind.description}>{kind.label}</Term> : <Badge>custom</Badge>}</td>
      <td>
        <span className={styles.bar}>
          <Bar share={ranked.probability ?? 0} />
          <span>{ranked.probability === null ? '–' : formatShare(share(ranked.probability))}</span>
        </span>
      </td>
      <td>
        {ranked.held_out_rmse === null ? (
          <span className={styles.muted}>{ranked.note === '' ? 'not tested' : ranked.note}</span>
        ) : (
          <span className={styles.bar}>
            <Bar share={ranked.held_out_rmse / worst} tone="bad" />
            <span>{formatFigure(ranked.held_out_rmse, unit)}</span>
          </span>
        )}
      </td>
      <td className={styles.number}>
        <Link href={addressToTry(ranked.id)} aria-label={`Try: ${effectName(ranked.id)}`}>
          Try
        </Link>
      </td>
    </tr>
  );
}

/** All effects with equation, probability and held-out error. */
export function Ranking({ ranking, effects, unit, without, addressToTry }: Props) {
  const [all, setAll] = useState(false);
  const worst = ranking.reduce((top, { held_out_rmse }) => Math.max(top, held_out_rmse ?? 0), without ?? 1e-12);
  const shown = all ? ranking : ranking.slice(0, kFew);
  return (
    <>
      <Scroll label="Effects, the most probable first">
        <table className={`${styles.table} ${styles.ranking}`} data-part="ranking">
          <caption className="hidden-visually">Effects, the most probable first</caption>
          <thead>
            <tr>
              <th scope="col">Effect and equation</th>
              <th scope="col">Kind</th>
              <th scope="col">
                <Term definition="Probability that exactly this effect is missing, computed from the error on held-out trials. Of the answers given with 80 %, about 80 % are correct.">
                  Probability
                </Term>
              </th>
              <th scope="col">
                <Term align="end" definition={kHeldOutMeaning}>
                  Held-out error with this effect
                </Term>
              </th>
              <th scope="col">
                <span className="hidden-visually">Actions</span>
              </th>
            </tr>
          </thead>
          <tbody>
            {shown.map((ranked) => (
              <Row
                key={ranked.id}
                ranked={ranked}
                effect={effects.find(({ id }) => id === ranked.id)}
                worst={worst}
                unit={unit}
                addressToTry={addressToTry}
              />
            ))}
          </tbody>
        </table>
      </Scroll>
      {ranking.length > kFew ? (
        <p>
          <Button look="quiet" onClick={() => setAll(!all)}>
            {all ? 'Show only the first six' : `Show all ${ranking.length}`}
          </Button>
        </p>
      ) : null}
    </>
  );
}
