import { useQuery } from '@tanstack/react-query';
import { metricsQuery, type MetricFacts, type Requirement, type StepProgress } from '@/api';
import { Badge, type Tone } from '@/ui';
import styles from './criteria.module.css';

/** The metrics that a bound can be put on, and the unit of each. */
export function useMetrics(): { readonly metrics: readonly MetricFacts[]; readonly unitOf: (id: string) => string } {
  const metrics = useQuery(metricsQuery).data?.metrics ?? [];
  return { metrics, unitOf: (id) => metrics.find((one) => one.id === id)?.unit ?? '1' };
}

/** Requirements in words, with where their bounds come from. */
export function Requirements({ of }: { readonly of: readonly Requirement[] }) {
  return (
    <ul className={styles.requirements}>
      {of.map(({ text, basis }) => (
        <li key={text}>
          {text}
          {basis === '' ? null : <span className={styles.basis}> — {basis}</span>}
        </li>
      ))}
    </ul>
  );
}

/** Requirements as they were judged: what was asked, what the trials show. */
export function Judged({ of }: { readonly of: StepProgress['requirements'] }) {
  return (
    <ul className={styles.requirements}>
      {of.map(({ met, required, found }) => (
        <li key={required}>
          <span aria-hidden="true">{met ? '✓ ' : '○ '}</span>
          {required}
          {found === '' ? null : (
            <>
              : <strong>{found}</strong>
            </>
          )}
          <span className="hidden-visually">{met ? ' (met)' : ' (not met)'}</span>
        </li>
      ))}
    </ul>
  );
}

const kStates: Record<StepProgress['state'], { readonly tone: Tone; readonly text: string }> = {
  passed: { tone: 'good', text: 'passed' },
  open: { tone: 'accent', text: 'open' },
  waiting: { tone: 'neutral', text: 'waiting' },
  used_up: { tone: 'warn', text: 'all trials done, not passed' },
  held: { tone: 'neutral', text: 'not released' },
};
export const stateText = (state: StepProgress['state']) => kStates[state].text;
export const StepState = ({ state }: { readonly state: StepProgress['state'] }) => (
  <Badge tone={kStates[state].tone}>{kStates[state].text}</Badge>
);
