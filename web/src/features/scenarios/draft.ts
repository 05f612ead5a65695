/** A scenario as it is being tuned: numbers as they are typed, in the units that a person tunes in. */
import type { ScenarioFile } from '@/api';
import { marked } from '@/language';

/** A number of the file: where it stands, how it is called, and by how much what is shown is larger. */
export interface Knob {
  readonly pointer: string;
  readonly label: string;
  readonly symbol: string;
  readonly unit: string;
  readonly times: number;
  readonly step: number;
  readonly description: string;
}

export const kBone: readonly Knob[] = [
  {
    pointer: '/bone/stiffness_N_per_m',
    label: marked('Stiffness K'),
    symbol: 'K',
    unit: 'N/mm',
    times: 1e-3,
    step: 0.5,
    description: marked('how fast resistance increases within a layer'),
  },
  {
    pointer: '/bone/damping_Ns_per_m',
    label: marked('Damping D'),
    symbol: 'D',
    unit: 'N·s/mm',
    times: 1e-3,
    step: 0.5,
    description: marked('how much resistance increases with speed'),
  },
  {
    pointer: '/bone/equilibrium_m',
    label: marked('Equilibrium x₀'),
    symbol: 'x₀',
    unit: 'mm',
    times: 1e3,
    step: 0.5,
    description: marked('position where the spring of a layer is unloaded; 0 or before the start of the layer'),
  },
  {
    pointer: '/bone/interval_m',
    label: marked('Layer thickness L'),
    symbol: 'L',
    unit: 'mm',
    times: 1e3,
    step: 0.5,
    description: marked('depth after which the next layer begins'),
  },
  {
    pointer: '/density',
    label: marked('Density'),
    symbol: '',
    unit: '',
    times: 1,
    step: 0.1,
    description: marked('multiplies K and D everywhere'),
  },
  {
    pointer: '/travel_m',
    label: marked('Probe stop'),
    symbol: '',
    unit: 'mm',
    times: 1e3,
    step: 1,
    description: marked('maximum travel of the stage'),
  },
];
export const kBreach: readonly Knob[] = [
  {
    pointer: '/breach/resistance_interval_m',
    label: marked('Resistance interval Rᵢ'),
    symbol: 'Rᵢ',
    unit: 'mm',
    times: 1e3,
    step: 0.5,
    description: marked('depth before a wall over which resistance increases'),
  },
  {
    pointer: '/breach/resistance_factor_per_m',
    label: marked('Resistance growth R_f'),
    symbol: 'R_f',
    unit: '1/mm',
    times: 1e-3,
    step: 0.005,
    description: marked('how steeply resistance increases'),
  },
  {
    pointer: '/breach/breach_interval_m',
    label: marked('Breach interval L_b'),
    symbol: 'L_b',
    unit: 'mm',
    times: 1e3,
    step: 0.5,
    description: marked('depth of soft tissue behind a wall'),
  },
  {
    pointer: '/breach/breach_damping_Ns_per_m',
    label: marked('Breach damping D_b'),
    symbol: 'D_b',
    unit: 'N·s/mm',
    times: 1e-3,
    step: 0.1,
    description: marked('resistance of the soft tissue to motion'),
  },
];

type Json = Record<string, unknown>;

/** The file with the value at a pointer put in place; the rest is as it was. */
export function withValue<File extends Json>(file: File, pointer: string, value: unknown): File {
  const [first = '', ...rest] = pointer.split('/').slice(1);
  if (rest.length === 0) return { ...file, [first]: value };
  const inner = file[first];
  const next = `/${rest.join('/')}`;
  if (Array.isArray(inner))
    return {
      ...file,
      [first]: inner.map((one: unknown, i) =>
        String(i) === rest[0]
          ? rest.length === 1
            ? value
            : withValue(one as Json, `/${rest.slice(1).join('/')}`, value)
          : one,
      ),
    };
  return { ...file, [first]: withValue((inner ?? {}) as Json, next, value) };
}

export function valueAt(file: Json, pointer: string): unknown {
  return pointer
    .split('/')
    .slice(1)
    .reduce<unknown>((at, key) => (typeof at === 'object' && at !== null ? (at as Json)[key] : undefined), file);
}

/** "8" shown in N/mm is 8000 N/m; free of the noise of a division. */
export const shown = (si: number, { times }: Pick<Knob, 'times'>) => String(Math.round(si * times * 1e6) / 1e6);
export const fromShown = (text: string, { times }: Pick<Knob, 'times'>) =>
  Math.round((Number(text) / times) * 1e12) / 1e12;

const kMetres = /(-?\d[\d.e+-]*) m(?![\w/²])/g;

/** Lengths in a message of the server, which are in metres, in millimetres. */
export const inMillimetres = (message: string) =>
  message.replace(kMetres, (_, metres: string) => `${shown(Number(metres), { times: 1e3 })} mm`);

/** The server's message about a number, in the unit of its field: the value leads the message, or stands in "value is outside low … high". */
export function inUnitsOf(message: string, knob: Pick<Knob, 'times' | 'unit'>): string {
  const unit = knob.unit === '' ? '' : ` ${knob.unit}`;
  const [, value, low, high] = /^(\S+) is outside (\S+) … (\S+)$/.exec(message) ?? [];
  if (
    value !== undefined &&
    low !== undefined &&
    high !== undefined &&
    [value, low, high].every((text) => Number.isFinite(Number(text)))
  ) {
    const [a, b, c] = [value, low, high].map((text) => shown(Number(text), knob));
    return `${a} is outside ${b} … ${c}${unit}`;
  }
  return inMillimetres(message.replace(/^-?\d[\d.e+-]*(?= (?!m\b))/, (text) => `${shown(Number(text), knob)}${unit}`));
}

/** What the server is given: who, when and of which version is its to say. */
export function draftOf(file: ScenarioFile): Json {
  return Object.fromEntries(Object.entries(file).filter(([key]) => key !== 'origin'));
}

const tidy = (value: number) => Math.round(value * 1e6) / 1e6;

/** Adds a wall in the middle of the longest gap between walls. */
export function withWall(file: ScenarioFile): ScenarioFile {
  const edges = [0, ...file.walls_m, file.travel_m];
  const gaps = edges.slice(1).map((edge, i) => ({ from: edges[i] ?? 0, wide: edge - (edges[i] ?? 0) }));
  const widest = gaps.reduce((most, gap) => (gap.wide > most.wide ? gap : most));
  return { ...file, walls_m: [...file.walls_m, tidy(widest.from + widest.wide / 2)].sort((a, b) => a - b) };
}

/** Adds a region of different density behind the last one. */
export function withLayer(file: ScenarioFile): ScenarioFile {
  const last = file.layers.at(-1),
    from = last ? last.start_m + last.thickness_m : 0;
  const thickness = Math.min(0.005, tidy(file.travel_m - from));
  return thickness <= 0
    ? file
    : { ...file, layers: [...file.layers, { start_m: tidy(from), thickness_m: thickness, density: 1.5 }] };
}
