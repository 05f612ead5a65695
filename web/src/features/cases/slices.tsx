import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import {
  boundsOf,
  sliceQuery,
  type Envelope,
  type PlannedTract,
  type Preview,
  type SlicePlane,
  type Vec3,
  type Window,
} from '@/api';
import { cutLines, normalOf, SliceView, type SliceBall, type SliceMark, type SlicePicture } from '@/charts';
import { marked, say } from '@/language';
import { Notice } from '@/ui';
import styles from './cases.module.css';
import { kBrushes, type Brush, type End, type EnvelopeMark, type Plan, type Tool } from './plan';

const kPlanes: readonly { plane: SlicePlane; name: string; axis: 0 | 1 | 2; ends: readonly [string, string] }[] = [
  { plane: 'axial', name: marked('Axial'), axis: 2, ends: [marked('feet'), marked('head')] },
  { plane: 'coronal', name: marked('Coronal'), axis: 1, ends: [marked('front'), marked('back')] },
  { plane: 'sagittal', name: marked('Sagittal'), axis: 0, ends: [marked('right'), marked('left')] },
];
const kPitch_m = 0.0005;
const kNoMarks: readonly EnvelopeMark[] = [];

const add = (a: Vec3, b: Vec3, by: number): Vec3 => [a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]];

/** Faces of the walls along the tract, the tract itself, the breach. */
function marksOf(plan: Plan, found: PlannedTract | undefined): SliceMark[] {
  const out: SliceMark[] = [];
  const tract = found?.tract;
  if (tract) {
    const towards: Record<string, Vec3> = {
      medial: tract.medial,
      lateral: add([0, 0, 0], tract.medial, -1),
      superior: tract.superior,
      inferior: add([0, 0, 0], tract.superior, -1),
      anterior: tract.axis,
    };
    for (const { wall, depth_m, inner_m, thickness_m } of found.walls) {
      const side = towards[wall];
      if (!side || wall === 'anterior') continue;
      for (let i = 0; i + 2 < depth_m.length; i += 2) {
        for (const face of ['inner', 'outer'] as const) {
          const place = (at: number) => {
            const inner = inner_m[at],
              thick = thickness_m[at];
            if (inner === null || inner === undefined || thick === null || thick === undefined || inner > 0.015)
              return null;
            return add(
              add(tract.entry_m, tract.axis, depth_m[at] ?? 0),
              side,
              face === 'inner' ? inner : inner + thick,
            );
          };
          const from = place(i),
            to = place(i + 2);
          if (from && to) out.push({ id: `${wall} ${face} ${i}`, at: from, to, look: 'wall', wide: 0.35 });
        }
      }
    }
  }
  if (plan.entry && plan.target) out.push({ id: 'tract', at: plan.entry, to: plan.target, look: 'tract', wide: 1.2 });
  if (found?.breach) {
    out.push({ id: 'breach', at: found.breach.from_m, to: found.breach.tip_m, look: 'breach', wide: 1.4 });
    out.push({ id: 'hole', at: found.breach.breach_m, look: 'breach', text: say('breach'), fixed: true });
  }
  if (plan.target) out.push({ id: 'target', at: plan.target, look: 'target', text: say('target') });
  if (plan.entry) out.push({ id: 'entry', at: plan.entry, look: 'entry', text: say('entry') });
  return out;
}

interface Props {
  readonly volume: string;
  readonly block: Preview;
  readonly window: Window;
  readonly plan: Plan;
  readonly found: PlannedTract | undefined;
  readonly tool: Tool;
  readonly brush_m: number;
  readonly focus: Vec3;
  readonly onFocus: (at: Vec3) => void;
  readonly onPlace: (end: End, at: Vec3, done: boolean) => void;
  /** `first`: a stroke of the brush begins. */
  readonly onBrush: (brush: Brush, at_m: Vec3, first: boolean) => void;
}

const signOf = (bone: boolean) => (bone ? '+' : '−');
const kSigns = { bone: '+', no_bone: '−', erase: '×' } as const;
const ballOf = ({ at_m, radius_m, bone }: EnvelopeMark): SliceBall => ({ at: at_m, radius_m, sign: signOf(bone) });

/** Where the slice that is shown cuts the envelope. */
function outlineOf(envelope: Envelope | null, picture: SlicePicture | undefined) {
  return envelope && picture ? cutLines(envelope, { origin_m: picture.origin_m, normal: normalOf(picture) }) : [];
}

type Placed = (typeof kPlanes)[number];

/** One plane; while the next slice is on its way, the one before stays. */
function OnePlane({
  where: { plane, name, axis, ends },
  low,
  high,
  marks,
  balls,
  volume,
  window,
  found,
  tool,
  brush_m,
  focus,
  onFocus,
  onPlace,
  onBrush,
}: Props & {
  readonly where: Placed;
  readonly low: Vec3;
  readonly high: Vec3;
  readonly marks: readonly SliceMark[];
  readonly balls: readonly SliceBall[];
}) {
  const at =
    Math.round(Math.min(Math.max(Math.round(focus[axis] / kPitch_m) * kPitch_m, low[axis]), high[axis]) * 1e6) / 1e6;
  const query = useQuery(sliceQuery(volume, plane, at, window));
  const envelope = found?.envelope ?? null;
  const outline = useMemo(() => outlineOf(envelope, query.data), [envelope, query.data]);
  const brush = kBrushes.find((one) => one === tool);
  return (
    <div>
      {query.isError ? (
        <Notice tone="bad" title={say('This slice could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <SliceView
        name={say(name)}
        picture={query.data ?? null}
        late={query.isPlaceholderData}
        at_m={at}
        from_m={low[axis]}
        to_m={high[axis]}
        ends={[say(ends[0]), say(ends[1])]}
        marks={marks}
        chosen={brush ? '' : tool}
        outline={outline}
        balls={balls}
        brush={
          brush
            ? {
                radius_m: brush_m,
                sign: kSigns[brush],
                cursor: focus,
                onCursor: onFocus,
                onPaint: (place, first) => onBrush(brush, [...place], first),
              }
            : null
        }
        onAt={(to) => onFocus([axis === 0 ? to : focus[0], axis === 1 ? to : focus[1], axis === 2 ? to : focus[2]])}
        onPlace={(id, to, done) => {
          if (id === 'entry' || id === 'target') onPlace(id, to, done);
        }}
      />
    </div>
  );
}

/** What the lines and signs over the slices are. */
function Legend({ envelope, marks }: { readonly envelope: Envelope | null; readonly marks: readonly EnvelopeMark[] }) {
  return (
    <ul className={styles.sliceLegend} data-part="slice-legend">
      {envelope ? (
        <li>
          <span className={styles.sample} data-line="envelope" aria-hidden="true" />
          {say('Envelope: outer face of the vertebra; all bone within it is filled')}
        </li>
      ) : null}
      {([true, false] as const)
        .filter((bone) => marks.some((mark) => mark.bone === bone))
        .map((bone) => (
          <li key={String(bone)}>
            <span className={styles.sign} data-brush={bone ? 'bone' : 'no_bone'} aria-hidden="true" />
            {bone ? say('Marked: bone here') : say('Marked: no bone here')}
          </li>
        ))}
    </ul>
  );
}

/** The volume in three planes through one point, with the plan drawn over it. */
export function Slices(props: Props) {
  const { block, plan, found } = props;
  const bounds = useMemo(() => boundsOf(block), [block]);
  const marks = useMemo(() => marksOf(plan, found), [plan, found]);
  const painted = plan.preparation === 'filled' ? plan.marks : kNoMarks;
  const balls = useMemo(() => painted.map(ballOf), [painted]);
  return (
    <>
      <div className={styles.slices}>
        {kPlanes.map((where) => (
          <OnePlane key={where.plane} where={where} marks={marks} balls={balls} {...bounds} {...props} />
        ))}
      </div>
      <Legend envelope={found?.envelope ?? null} marks={painted} />
    </>
  );
}
