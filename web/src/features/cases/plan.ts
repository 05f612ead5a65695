/** The plan of a case while it is edited. Each step is a value, so that it can be undone. */
import { kWalls, type NewCase, type TractRequest, type Vec3 } from '@/api';

export type WallName = (typeof kWalls)[number];
export type End = 'entry' | 'target';
/** What a brush does: it marks bone, or no bone, or takes marks away. */
export const kBrushes = ['bone', 'no_bone', 'erase'] as const;
export type Brush = (typeof kBrushes)[number];
/** What a click in a slice does: it places an end of the tract, or uses a brush. */
export type Tool = End | Brush;

export interface Breach {
  readonly wall: WallName;
  readonly depth_m: number;
  /** null: where the wall is thinnest. */ readonly at_m: number | null;
}
/** A ball in which a person says that bone is, or is not, where the envelope that was found is wrong. */
export type EnvelopeMark = Readonly<NonNullable<TractRequest['envelope_marks']>[number]>;
export interface Plan {
  readonly entry: Vec3 | null;
  readonly target: Vec3 | null;
  readonly radius_m: number;
  readonly breach: Breach | null;
  /** No channel is made: trainees drill it. */ readonly whole: boolean;
  /** How the bone is made ready: the CT's own values, or all of it felt. */ readonly preparation: Preparation;
  /** Corrections of the envelope, in the order in which they were painted. */ readonly marks: readonly EnvelopeMark[];
}
export type Preparation = 'published' | 'filled';

export const kNoPlan: Plan = {
  entry: null,
  target: null,
  radius_m: 0.0015,
  breach: null,
  whole: false,
  preparation: 'filled',
  marks: [],
};

export interface Drawing {
  readonly plan: Plan;
  readonly past: readonly Plan[];
  readonly future: readonly Plan[];
}

const kMostSteps = 100;

export type Step =
  | {
      readonly kind: 'change';
      readonly to: Partial<Plan>;
      /** Part of a drag: no step of its own. */ readonly passing?: boolean;
    }
  | {
      readonly kind: 'paint';
      readonly mark: EnvelopeMark;
      /** Part of a drag: no step of its own. */ readonly passing?: boolean;
    }
  | {
      /** Takes every mark away that this ball touches. */ readonly kind: 'erase';
      readonly at_m: Vec3;
      readonly radius_m: number;
      /** Part of a drag: no step of its own. */ readonly passing?: boolean;
    }
  | { readonly kind: 'undo' }
  | { readonly kind: 'redo' };

export function draw(drawing: Drawing, step: Step): Drawing {
  const { plan, past, future } = drawing;
  switch (step.kind) {
    case 'change': {
      const next = { ...plan, ...step.to };
      return step.passing
        ? { ...drawing, plan: next }
        : { plan: next, past: [...past, plan].slice(-kMostSteps), future: [] };
    }
    // The drawing itself knows the marks so far: of a quick drag several are painted before the page is drawn again.
    case 'paint':
      return plan.marks.length >= kMostMarks
        ? drawing
        : draw(drawing, { kind: 'change', to: { marks: [...plan.marks, step.mark] }, passing: step.passing ?? false });
    case 'erase': {
      const touched = ({ at_m, radius_m }: EnvelopeMark) =>
        Math.hypot(...at_m.map((value, axis) => value - (step.at_m[axis] ?? 0))) < radius_m + step.radius_m;
      const marks = plan.marks.filter((mark) => !touched(mark));
      return draw(drawing, { kind: 'change', to: { marks }, passing: step.passing ?? false });
    }
    case 'undo': {
      const before = past.at(-1);
      return before ? { plan: before, past: past.slice(0, -1), future: [plan, ...future] } : drawing;
    }
    case 'redo': {
      const [next, ...rest] = future;
      return next ? { plan: next, past: [...past, plan], future: rest } : drawing;
    }
  }
}

/** How far a breach may leave the bone; the server allows the same. */
export const kBreachDepth_mm = { least: 0.5, most: 15 } as const;
/** How many marks of the envelope there may be, and how large; the server allows the same. */
export const kMostMarks = 200;
const kMarkRadius_mm = { least: 1, most: 10 } as const;

const isBreachAllowed = ({ depth_m, at_m }: Breach) =>
  depth_m * 1000 >= kBreachDepth_mm.least && depth_m * 1000 <= kBreachDepth_mm.most && (at_m === null || at_m >= 0);

/** The request to the server, rounded to 1 µm; null while an end is missing or a number of the breach is not allowed. */
export function requestOf({ entry, target, radius_m, breach, whole, preparation, marks }: Plan): TractRequest | null {
  if (!entry || !target) return null;
  if (breach && !whole && !isBreachAllowed(breach)) return null;
  return {
    entry_m: tidy(entry),
    target_m: tidy(target),
    radius_m,
    channel: whole ? 'planned' : 'drilled',
    preparation,
    breach:
      breach && !whole
        ? { wall: breach.wall, depth_m: breach.depth_m, ...(breach.at_m === null ? {} : { at_m: breach.at_m }) }
        : null,
    ...(preparation === 'filled' && marks.length > 0
      ? {
          envelope_marks: marks.map((mark) => ({
            at_m: tidy(mark.at_m),
            radius_m: round(mark.radius_m),
            bone: mark.bone,
          })),
        }
      : {}),
  };
}
const round = (value: number) => Math.round(value * 1e6) / 1e6;
const tidy = (p: Vec3): [number, number, number] => [round(p[0]), round(p[1]), round(p[2])];

export const caseOf = (request: TractRequest, volume: string, title: string): NewCase => ({
  ...request,
  volume,
  title,
});

/** Five cases of one tract, a breach of each wall, all as hard to tell as can be. */
export const fiveOf = (request: TractRequest, volume: string, title: string): NewCase[] =>
  kWalls.map((wall) => ({
    ...caseOf(request, volume, `${title}, ${wall} breach`),
    breach: { wall, depth_m: request.breach?.depth_m ?? 0.003, even: true },
  }));

/** The plan as part of an address, in millimetres: a link to it can be kept. */
export function toAddress({ entry, target, radius_m, breach, whole, preparation, marks }: Plan): string {
  const parameters = new URLSearchParams();
  if (entry) parameters.set('entry', mm(entry));
  if (target) parameters.set('target', mm(target));
  if (radius_m !== kNoPlan.radius_m) parameters.set('radius', String(Math.round(radius_m * 1e5) / 100));
  if (whole) parameters.set('whole', '1');
  if (preparation !== kNoPlan.preparation) parameters.set('bone', preparation);
  if (breach)
    parameters.set(
      'breach',
      [breach.wall, breach.depth_m * 1000, ...(breach.at_m === null ? [] : [breach.at_m * 1000])].join(','),
    );
  // Written as they are: encoded, two hundred marks would make the address half as long again.
  const painted = marks.map((one) => [mm(one.at_m), mm([one.radius_m]), one.bone ? '+' : '-'].join(',')).join(';');
  return [parameters.toString(), painted && `marks=${painted}`].filter(Boolean).join('&');
}
const mm = (lengths_m: readonly number[]) => lengths_m.map((value) => Math.round(value * 1e5) / 100).join(',');

/** Marks of an address, without those that are none. A plus sign in an address may be read as a space. */
function marksOf(text: string | null): EnvelopeMark[] {
  const marks = (text ?? '').split(';').flatMap((part): EnvelopeMark[] => {
    const [x, y, z, radius, sign, ...more] = part.split(',');
    const at = pointOf([x, y, z].join(','));
    const radius_mm = Number(radius);
    const allowed = radius_mm >= kMarkRadius_mm.least && radius_mm <= kMarkRadius_mm.most;
    if (!at || !allowed || sign === undefined || !'+ -'.includes(sign) || sign.length !== 1 || more.length > 0)
      return [];
    return [{ at_m: [...at], radius_m: radius_mm / 1000, bone: sign !== '-' }];
  });
  return marks.slice(0, kMostMarks);
}

function pointOf(text: string | null): Vec3 | null {
  const [x, y, z, ...more] = (text ?? '')
    .split(',')
    .map((part) => (part.trim() === '' ? Number.NaN : Number(part) / 1000));
  return x !== undefined && y !== undefined && z !== undefined && more.length === 0 && [x, y, z].every(Number.isFinite)
    ? [x, y, z]
    : null;
}

export function fromAddress(search: string): Plan {
  const parameters = new URLSearchParams(search);
  const [wall, depth, at] = (parameters.get('breach') ?? '').split(',');
  const known = kWalls.find((one) => one === wall);
  const number = (text: string | undefined | null, otherwise: number) =>
    text && Number.isFinite(Number(text)) ? Number(text) / 1000 : otherwise;
  return {
    entry: pointOf(parameters.get('entry')),
    target: pointOf(parameters.get('target')),
    radius_m: number(parameters.get('radius'), kNoPlan.radius_m),
    whole: parameters.get('whole') === '1',
    preparation: parameters.get('bone') === 'published' ? 'published' : 'filled',
    breach: known
      ? { wall: known, depth_m: number(depth, 0.003), at_m: at === undefined ? null : number(at, 0) }
      : null,
    marks: marksOf(parameters.get('marks')),
  };
}
