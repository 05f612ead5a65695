import { useQuery } from '@tanstack/react-query';
import { heard, metricsQuery, type MetricFacts, type Requirement, type StepProgress } from '@/api';
import { marked, say } from '@/language';
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
          {heard(text)}
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
          {heard(required)}
          {found === '' ? null : (
            <>
              : <strong>{heard(found)}</strong>
            </>
          )}
          <span className="hidden-visually"> {met ? say('(met)') : say('(not met)')}</span>
        </li>
      ))}
    </ul>
  );
}

const kStates: Record<StepProgress['state'], { readonly tone: Tone; readonly text: string }> = {
  passed: { tone: 'good', text: marked('passed') },
  open: { tone: 'accent', text: marked('open') },
  waiting: { tone: 'neutral', text: marked('waiting') },
  used_up: { tone: 'warn', text: marked('all trials done, not passed') },
  held: { tone: 'neutral', text: marked('not released') },
};
export const stateText = (state: StepProgress['state']) => say(kStates[state].text);
export const StepState = ({ state }: { readonly state: StepProgress['state'] }) => (
  <Badge tone={kStates[state].tone}>{say(kStates[state].text)}</Badge>
);
