import type { Trial } from '@/api';
import { say } from '@/language';
import { Badge, Card, Facts, Term } from '@/ui';
import { formatCount, formatShare, share } from '@/units';
import styles from './verdict.module.css';

/** From this share of the samples on, a fault of the recording is named in the headline. */
const kWorthSaying = 0.01;

function counted(count: number, of: number): string {
  return count === 0 ? say('none') : `${formatCount(count)} (${formatShare(share(of > 0 ? count / of : 1), 2)})`;
}

function headline(trial: Trial): { text: string; sound: boolean } {
  const { samples, late_ticks, not_converged, skipped_ticks } = trial;
  const named = [
    ...(trial.complete ? [] : [say('The recording is incomplete: the station stopped before the end of the trial.')]),
    ...(skipped_ticks > 0 ? [say('Ticks were skipped.')] : []),
    ...(late_ticks > kWorthSaying * samples ? [say('Many ticks were late.')] : []),
    ...(not_converged > kWorthSaying * samples ? [say('Many steps did not converge.')] : []),
  ];
  if (named.length === 0)
    return {
      text: late_ticks + not_converged === 0 ? say('No faults.') : say('Usable; the few faults are counted below.'),
      sound: true,
    };
  return { text: named.join(' '), sound: false };
}

/** How far the recording may be trusted: every fault counted. */
export function Recording({ trial }: { readonly trial: Trial }) {
  const { text, sound } = headline(trial);
  const { samples } = trial;
  return (
    <Card
      title={say('Recording')}
      aside={<Badge tone={sound ? 'good' : 'warn'}>{sound ? say('usable') : say('has faults')}</Badge>}
    >
      <p className={styles.headline}>{text}</p>
      <Facts
        facts={[
          {
            name: say('Late ticks'),
            value: (
              <Term
                definition={say(
                  'Ticks of the force loop that started more than a quarter of a period late. The force was late; the sample was recorded.',
                )}
              >
                {counted(trial.late_ticks, samples)}
              </Term>
            ),
          },
          {
            name: say('Skipped ticks'),
            value: (
              <Term definition={say('Ticks that did not run: their samples are missing.')}>
                {counted(trial.skipped_ticks, samples + trial.skipped_ticks)}
              </Term>
            ),
          },
          ...(trial.rig === 'probing'
            ? []
            : [
                {
                  name: say('Steps not converged'),
                  value: (
                    <Term
                      definition={say(
                        'Samples in which the bending of the shank was not computed to the published tolerance of 0.001 N. The best estimate was rendered.',
                      )}
                    >
                      {counted(trial.not_converged, samples)}
                    </Term>
                  ),
                },
              ]),
        ]}
      />
    </Card>
  );
}
