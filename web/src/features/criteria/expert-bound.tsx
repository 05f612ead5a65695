import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { cohortsQuery, expertBoundQuery, type BoundMethod, type ExpertBound as Found } from '@/api';
import { Plane } from '@/charts';
import { marked, say } from '@/language';
import { Button, Field, Notice, Select, useSettled } from '@/ui';
import { formatCount, formatFigure, formatShare, plainNumber, typedIn } from '@/units';
import styles from './criteria.module.css';
import type { RequirementDraft } from './draft';

const kMethods: readonly { readonly value: BoundMethod; readonly text: string }[] = [
  { value: 'mean_sd', text: marked('Mean of the experts ± standard deviations') },
  { value: 'percentile', text: marked('Percentile of the experts') },
  { value: 'youden', text: marked('Cut between experts and novices (ROC, Youden)') },
];

/** Places of dots that would lie on each other: one above the other, in columns of the picture's width. */
function stacked(values: readonly number[], from: number, to: number): readonly (readonly [number, number])[] {
  const kColumns = 60;
  const heights = new Map<number, number>();
  return values.map((value) => {
    const column = Math.floor(((value - from) / (to - from)) * kColumns);
    const height = heights.get(column) ?? 0;
    heights.set(column, height + 1);
    return [value, height] as const;
  });
}

/** Both distributions, a dot a trial, and the bound between them. */
function Distributions({ of, unit, metric }: { readonly of: Found; readonly unit: string; readonly metric: string }) {
  const { unit: shown, perSi } = typedIn(unit);
  const groups = [
    { name: say('experts'), group: of.experts, className: styles.experts },
    { name: say('novices'), group: of.novices, className: styles.novices },
  ].filter(({ group }) => group.values.length > 0);
  const all = [...groups.flatMap(({ group }) => group.values), of.bound].map((value) => value * perSi);
  const least = Math.min(...all),
    most = Math.max(...all);
  const margin = (most - least) * 0.05 || 1;
  const from = least - margin,
    to = most + margin;
  const dots = groups.map((one) => ({
    ...one,
    dots: stacked(
      one.group.values.map((value) => value * perSi),
      from,
      to,
    ),
  }));
  const highest = Math.max(1, ...dots.flatMap((one) => one.dots.map(([, height]) => height)));
  return (
    <>
      <Plane
        across={{ title: shown === '' ? metric : say('{metric} in {unit}', { metric, unit: shown }), from, to }}
        up={{ title: '', from: 0, to: groups.length, ticks: [] }}
        height_px={200}
        summary={`${groups
          .map(({ name, group }) => say('{count} trials of {name}', { count: formatCount(group.values.length), name }))
          .join(', ')}; ${say('the bound is {bound}.', { bound: formatFigure(of.bound, unit) })}`}
        data={{
          name: `bound of ${metric}`,
          columns: ['group', shown === '' ? 'value' : `value_${shown}`],
          rows: dots.flatMap((one) => one.dots.map(([value]) => [one.name, value])),
        }}
      >
        {(places) => (
          <>
            {dots.map((one, row) => (
              <g key={one.name} className={one.className}>
                {one.dots.map(([value, height], i) => (
                  <circle
                    key={i}
                    cx={places.x(value)}
                    cy={places.y(groups.length - 1 - row + 0.12 + (height / (highest + 1)) * 0.7)}
                    r={3}
                  />
                ))}
                <text x={places.x(from) + 4} y={places.y(groups.length - row) + 14}>
                  {one.name}
                </text>
              </g>
            ))}
            <g className={styles.bound}>
              <line
                x1={places.x(of.bound * perSi)}
                x2={places.x(of.bound * perSi)}
                y1={places.y(0)}
                y2={places.y(groups.length)}
              />
              <text x={places.x(of.bound * perSi) + 4} y={places.y(0) - 4}>
                {formatFigure(of.bound, unit)}
              </text>
            </g>
          </>
        )}
      </Plane>
      {of.experts.simulated || of.novices.simulated ? (
        <p className={styles.muted}>{say('Some trials are simulated.')}</p>
      ) : null}
    </>
  );
}

/** Takes a bound from trials of experts, with the picture that it rests on. */
export function ExpertBound({
  draft,
  unit,
  label,
  onBound,
}: {
  readonly draft: RequirementDraft;
  readonly unit: string;
  readonly label: string;
  readonly onBound: (bound: string, basis: string) => void;
}) {
  const cohorts = useQuery(cohortsQuery).data?.cohorts ?? [];
  const [experts, setExperts] = useState('');
  const [novices, setNovices] = useState('');
  const [method, setMethod] = useState<BoundMethod>('mean_sd');
  const [number, setNumber] = useState('2');
  const typed = Number(useSettled(number, 250));
  const value = Number.isFinite(typed) ? typed : 0;
  const found = useQuery(
    expertBoundQuery({
      metric: draft.metric,
      side: draft.side,
      method,
      experts,
      novices,
      // What is worse than the mean passes too, by so many deviations.
      k: method === 'mean_sd' ? (draft.side === 'at_most' ? value : -value) : 0,
      share: method === 'percentile' ? Math.min(Math.max(value / 100, 0), 1) : 0,
    }),
  );
  const choices = cohorts.map(({ id, name }) => ({ value: id, text: name }));
  const take = (next: BoundMethod) => {
    setMethod(next);
    setNumber(next === 'percentile' ? (draft.side === 'at_most' ? '90' : '10') : '2');
  };
  const { perSi } = typedIn(unit);
  return (
    <div className={styles.fromExperts}>
      <div className={styles.form}>
        <Select
          label={say('Experts')}
          value={experts}
          onChange={(event) => setExperts(event.target.value)}
          options={[{ value: '', text: say('Choose a cohort') }, ...choices]}
        />
        <Select
          label={say('Novices')}
          value={novices}
          onChange={(event) => setNovices(event.target.value)}
          options={[{ value: '', text: method === 'youden' ? say('Choose a cohort') : 'none' }, ...choices]}
        />
        <Select
          label={say('Method')}
          value={method}
          onChange={(event) => {
            const next = kMethods.find((one) => one.value === event.target.value);
            if (next) take(next.value);
          }}
          options={kMethods.map(({ value, text }) => ({ value, text: say(text) }))}
        />
        {method === 'youden' ? null : (
          <Field
            label={method === 'mean_sd' ? say('Standard deviations') : say('Percentile, %')}
            inputMode="decimal"
            value={number}
            onChange={(event) => setNumber(event.target.value)}
          />
        )}
      </div>
      {found.isError ? (
        <Notice tone="bad" title={say('No bound could be computed.')}>
          {found.error.message}
        </Notice>
      ) : null}
      {found.data ? (
        <>
          <Distributions of={found.data} unit={unit} metric={label} />
          <p className={styles.muted}>
            {found.data.area === null
              ? ''
              : `${say(
                  'Area under the ROC curve {area}; {sensitivity} of the experts’ trials pass, {specificity} of the novices’ do not.',
                  {
                    area: formatFigure(found.data.area),
                    sensitivity: formatShare(found.data.sensitivity ?? (0 as never)),
                    specificity: formatShare(found.data.specificity ?? (0 as never)),
                  },
                )} `}
            {say(
              '{people, plural, one {One expert} other {# experts}}: trials of one person are alike, so that few people make an uncertain bound.',
              { people: found.data.experts.people },
            )}
          </p>
          <Button onClick={() => onBound(plainNumber(rounded(found.data.bound * perSi)), found.data.basis)}>
            {say('Use {bound} as the bound', { bound: formatFigure(found.data.bound, unit) })}
          </Button>
        </>
      ) : null}
    </div>
  );
}

/** Four significant digits: a bound is not known better. */
const rounded = (value: number) => {
  if (value === 0) return 0;
  const step = 10 ** (Math.floor(Math.log10(Math.abs(value))) - 3);
  return Math.round(value / step) * step;
};
