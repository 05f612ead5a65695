import type { Calibration, PlannedTract } from '@/api';
import { say, Sentence } from '@/language';
import { wallName } from '@/ui';
import { formatLength, formatMeasure, metre } from '@/units';
import styles from './cases.module.css';
import type { Plan } from './plan';

/** The server's findings about the plan, as sentences. */
export function Findings({
  plan,
  found,
  looking,
}: {
  readonly plan: Plan;
  readonly found: PlannedTract | undefined;
  readonly looking: boolean;
}) {
  if (!plan.entry || !plan.target)
    return (
      <p className={styles.muted} role="status">
        {say('Place the entry, then the target: click in a slice, drag a marker, or enter coordinates.')}
      </p>
    );
  if (!found)
    return (
      <p className={styles.muted} role="status">
        {looking ? say('Analysing the bone…') : ''}
      </p>
    );
  const { breach, problems, warnings } = found;
  return (
    <div className={styles.findings} data-part="findings" data-late={looking || undefined} role="status">
      {problems.map((problem) => (
        <p key={problem} className={styles.problem}>
          {problem}
        </p>
      ))}
      {problems.length > 0 && plan.preparation === 'filled' && found.envelope ? (
        <p data-part="advice">
          {say(
            'Compare the dashed outline in the slices with the bone: paint where bone is or is not (“Bone here”, “No bone here”), or move the entry or the target.',
          )}
        </p>
      ) : null}
      {warnings.map((warning) => (
        <p key={warning} data-part="warning">
          {say('Warning: {warning}', { warning })}
        </p>
      ))}
      {found.tract ? (
        <p>
          {found.side === 'left'
            ? say('Left side, tract of {length}.', { length: formatLength(found.length_m) })
            : say('Right side, tract of {length}.', { length: formatLength(found.length_m) })}
        </p>
      ) : null}
      {breach ? (
        <p data-part="breach">
          <Sentence
            text="The {wall} wall is breached at a depth of <strong>{at}</strong>, where it is <strong>{thickness}</strong> thick; the tool extends {beyond} beyond the bone."
            values={{
              wall: wallName(breach.wall),
              at: formatLength(breach.at_m),
              thickness: formatLength(breach.wall_thickness_m),
              beyond: formatLength(breach.depth_m),
            }}
            parts={{ strong: (words) => <strong>{words}</strong> }}
          />
        </p>
      ) : found.tract ? (
        <p>
          {plan.whole
            ? say('No channel is pre-drilled: trainees drill this tract and then palpate it.')
            : say('No wall is breached.')}
        </p>
      ) : null}
    </div>
  );
}

const peak = (value_HU: number | null) =>
  value_HU === null ? say('not found') : formatMeasure(Math.round(value_HU), 'HU');

/** By which CT values the server knows bone from what is round it: a person sees at once whether they are those of a CT. */
export function Peaks({ calibration }: { readonly calibration: Calibration }) {
  return (
    <p className={styles.muted} data-part="peaks">
      {say(
        'Peaks of the CT values: air {air}, fat {fat}, soft tissue {tissue}, cancellous bone {cancellous}, cortical bone {cortical}; thickness of the cortex {thickness}.',
        {
          air: peak(calibration.air_HU),
          fat: peak(calibration.fat_HU),
          tissue: peak(calibration.soft_tissue_HU),
          cancellous: peak(calibration.cancellous_HU),
          cortical: peak(calibration.cortical_HU),
          thickness: calibration.cortex_m === null ? say('not found') : formatLength(metre(calibration.cortex_m), 2),
        },
      )}
    </p>
  );
}
