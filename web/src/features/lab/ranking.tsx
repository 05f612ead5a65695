import { useState } from 'react';
import { Link } from 'wouter';
import type { Effect, Ranked } from '@/api';
import { marked, say } from '@/language';
import { Badge, Bar, Button, DataTable, Term } from '@/ui';
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

function Law({ effect }: { readonly effect: Effect | undefined }) {
  return effect ? (
    <span className={styles.law}>
      <code>{effect.equation}</code>
      <span className={styles.muted}>{effect.summary}</span>
    </span>
  ) : null;
}

/** All effects with equation, probability and held-out error. */
export function Ranking({ ranking, effects, unit, without, addressToTry }: Props) {
  const [all, setAll] = useState(false);
  const worst = ranking.reduce((top, { held_out_rmse }) => Math.max(top, held_out_rmse ?? 0), without ?? 1e-12);
  const effectOf = ({ id }: Ranked) => effects.find((one) => one.id === id);
  const kindOf = (ranked: Ranked) => {
    const effect = effectOf(ranked);
    return effect ? kEffectKinds[effect.kind] : null;
  };
  return (
    <DataTable<Ranked>
      caption={say('Effects')}
      order={say('the most probable first')}
      className={styles.ranking}
      rows={ranking}
      keyOf={({ id }) => id}
      empty={say('No effects.')}
      pageSize={all ? ranking.length : kFew}
      below={
        ranking.length > kFew ? (
          <p>
            <Button look="quiet" onClick={() => setAll(!all)}>
              {all ? say('Show only the first six') : say('Show all {count}', { count: ranking.length })}
            </Button>
          </p>
        ) : null
      }
      columns={[
        {
          name: marked('Effect and equation'),
          by: ({ id }) => effectName(id),
          cell: (ranked) => (
            <>
              {effectName(ranked.id)}
              <Law effect={effectOf(ranked)} />
            </>
          ),
        },
        {
          name: marked('Kind'),
          by: (ranked) => say(kindOf(ranked)?.label ?? 'custom'),
          cell: (ranked) => {
            const kind = kindOf(ranked);
            return kind ? (
              <Term definition={say(kind.description)}>{say(kind.label)}</Term>
            ) : (
              <Badge>{say('custom')}</Badge>
            );
          },
        },
        {
          name: (
            <Term
              definition={say(
                'Probability that exactly this effect is missing, computed from the error on held-out trials. Of the answers given with 80 %, about 80 % are correct.',
              )}
            >
              {say('Probability')}
            </Term>
          ),
          title: marked('Probability'),
          by: ({ probability }) => probability,
          cell: ({ probability }) => (
            <span className={styles.bar}>
              <Bar share={probability ?? 0} />
              <span>{probability === null ? '–' : formatShare(share(probability))}</span>
            </span>
          ),
        },
        {
          name: (
            <Term align="end" definition={say(kHeldOutMeaning)}>
              {say('Held-out error with this effect')}
            </Term>
          ),
          title: marked('Held-out error with this effect'),
          by: ({ held_out_rmse }) => held_out_rmse,
          cell: ({ held_out_rmse, note }) =>
            held_out_rmse === null ? (
              <span className={styles.muted}>{note === '' ? say('not tested') : note}</span>
            ) : (
              <span className={styles.bar}>
                <Bar share={held_out_rmse / worst} tone="bad" />
                <span>{formatFigure(held_out_rmse, unit)}</span>
              </span>
            ),
        },
        ...(ranking.some(({ detection_limits }) => detection_limits.length > 0)
          ? [
              {
                name: (
                  <Term
                    align="end"
                    definition={say(
                      'The smallest value at which these measurements would have shown the effect, computed from the fitted model and its residual.',
                    )}
                  >
                    {say('Detectable from')}
                  </Term>
                ),
                title: marked('Detectable from'),
                cell: ({ detection_limits }: Ranked) => detection_limits.map(({ text }) => text).join(', '),
              },
            ]
          : []),
        {
          name: <span className="hidden-visually">{say('Actions')}</span>,
          number: true,
          cell: ({ id }) => (
            <Link href={addressToTry(id)} aria-label={say('Try: {effect}', { effect: effectName(id) })}>
              {say('Try')}
            </Link>
          ),
        },
      ]}
    />
  );
}
