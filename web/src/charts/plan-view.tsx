import { useMemo } from 'react';
import { say } from '@/language';
import type { SceneBone, SceneBreach, SceneTract } from './scene/types';
import { Stage, type StageProps } from './stage';

interface Props extends Pick<StageProps, 'palette' | 'summary' | 'button'> {
  /** null: the bone alone is shown, as none is planned yet. */
  readonly tract: SceneTract | null;
  readonly breach: SceneBreach | null;
  /** null where it could not be fetched. */
  readonly bone: SceneBone | null;
}

const kNoPath = { t_s: [], tip_m: [], force_N: [] } as const;
const kColours = { bone: '--bone', tract: '--accent', moment: '--bad', ghost: '--accent' } as const;

/** Without a tract: through the middle of the bone, from behind, so that the view has somewhere to look. */
function throughTheMiddle(bone: SceneBone): SceneTract {
  const d = bone.directions;
  const half = bone.dims.map((n, i) => ((n - 1) / 2) * (bone.spacing_m[i] ?? 0));
  const middle = ([0, 1, 2] as const).map(
    (row) => bone.origin_m[row] + [0, 1, 2].reduce((total, i) => total + (d[3 * row + i] ?? 0) * (half[i] ?? 0), 0),
  );
  return {
    entry_m: [middle[0] ?? 0, (middle[1] ?? 0) + 0.03, middle[2] ?? 0],
    axis: [0, -1, 0],
    length_m: 0.06,
    radius_m: 0.0015,
    medial: [1, 0, 0],
    superior: [0, 0, 1],
  };
}

/** A planned tract and its breach in the bone, to be turned about. */
export function PlanView({ tract, breach, bone, palette, summary, button }: Props) {
  const content = useMemo(() => {
    const at = tract ?? (bone ? throughTheMiddle(bone) : null);
    return at && { tract: at, path: kNoPath, bone, most_N: 1, breach, bare: tract === null };
  }, [tract, breach, bone]);
  return (
    <Stage
      content={content}
      colours={kColours}
      palette={palette}
      label={say('View of the bone')}
      summary={summary}
      button={button}
    />
  );
}
