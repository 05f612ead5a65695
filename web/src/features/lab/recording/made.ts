/** What the lab and the measuring room take, made of a recording. */
import { say } from '@/language';
import { checkStamps, joined, kMostPeriods, type Series } from './join';
import type { Clock, Recording, Topic } from './mcap';

export const kColumns = ['x_m', 'theta_rad', 'fz_N', 'tz_Nm'] as const;
export type Column = (typeof kColumns)[number];

/** Units in which a column may be recorded, and how many of the column's own unit each is. */
export const kUnits: Readonly<Record<Column, Readonly<Record<string, number>>>> = {
  x_m: { m: 1, cm: 1e-2, mm: 1e-3, µm: 1e-6 },
  theta_rad: { rad: 1, '°': Math.PI / 180 },
  fz_N: { N: 1, mN: 1e-3, kN: 1e3 },
  tz_Nm: { Nm: 1, Nmm: 1e-3, Ncm: 1e-2 },
};

/** Column = (recorded − zero) · factor of the unit, with the other sign if it is reversed. */
export interface Chosen {
  readonly topic: Topic;
  readonly path: string;
  readonly unit: string;
  readonly zero: number;
  readonly reversed: boolean;
}
export type Choices = Readonly<Partial<Record<Column, Chosen | undefined>>>;

export interface Part {
  readonly clock: Clock;
  readonly from_s: number;
  readonly to_s: number;
}

export interface Trial {
  /** Of the first row in the recording. */
  readonly start_s: number;
  readonly t_s: Float64Array;
  readonly columns: readonly (readonly [Column, Float64Array])[];
  readonly notes: string;
}

function scaled(values: Float64Array, column: Column, { unit, zero, reversed }: Chosen): Float64Array {
  const factor = (kUnits[column][unit] ?? NaN) * (reversed ? -1 : 1);
  return values.map((value) => (value - zero) * factor);
}

/** The column on whose stamps the others are interpolated: the force's, else the torque's. */
export const baseOf = (choices: Choices): Column | null => (choices.fz_N ? 'fz_N' : choices.tz_Nm ? 'tz_Nm' : null);

/** What is still to be chosen, as a sentence; null if a set can be made. */
export function missing(choices: Choices): string | null {
  const slides = choices.x_m && choices.fz_N,
    turns = choices.theta_rad && choices.tz_Nm;
  return slides || turns ? null : say('Choose x_m and fz_N, or theta_rad and tz_Nm where the rig only turns.');
}

/** Each topic is read once, however many of its fields are columns. */
export async function probingTrial(recording: Recording, choices: Choices, part: Part): Promise<Trial> {
  const base = baseOf(choices);
  const lacking = missing(choices);
  if (lacking !== null || base === null) throw new Error(lacking ?? '');
  const wanted = kColumns.flatMap((column) => (choices[column] ? [[column, choices[column]] as const] : []));
  const first = choices[base]?.topic;
  const topics = [...new Set(wanted.map(([, { topic }]) => topic))].sort(
    (a, b) => Number(b === first) - Number(a === first),
  );
  const series: Series[] = [];
  for (const topic of topics) {
    const paths = wanted.filter(([, chosen]) => chosen.topic === topic).map(([, { path }]) => path);
    series.push(await recording.numbers(topic, paths, part.clock));
  }
  const [own, ...others] = series;
  if (!own) throw new Error(missing({}) ?? '');
  const table = joined(own, others, part.from_s, part.to_s);
  const columns = wanted.map(([column, chosen]) => {
    const at = topics.indexOf(chosen.topic);
    const within = wanted.filter(([, { topic }]) => topic === chosen.topic).findIndex(([name]) => name === column);
    return [column, scaled(table.values[at]?.[within] ?? new Float64Array(), column, chosen)] as const;
  });
  const start_s = table.t_s[0] ?? 0;
  return { start_s, t_s: table.t_s.map((t) => t - start_s), columns, notes: notesOf(recording, wanted, topics, part) };
}

/** How the table came to be, for whoever reads set.json later. */
function notesOf(
  { name }: Recording,
  wanted: readonly (readonly [Column, Chosen])[],
  topics: readonly Topic[],
  { clock }: Part,
): string {
  const sources = wanted.map(
    ([column, { topic, path, unit, zero, reversed }]) =>
      `${column}: ${topic.name} ${path} (${unit}${zero === 0 ? '' : `, zero at ${zero}`}${reversed ? ', reversed' : ''})`,
  );
  const stamps = clock === 'header' ? 'header stamps' : 'log times';
  const [base, ...others] = topics.map((topic) => topic.name);
  const how =
    others.length === 0
      ? ''
      : `; ${others.join(', ')} interpolated linearly at the stamps of ${base ?? ''}, gaps over ${kMostPeriods} periods refused`;
  return `from ${name}, ${stamps}; ${sources.join('; ')}${how}`;
}

function csv(header: readonly string[], columns: readonly Float64Array[]): string {
  const lines = [header.join(',')];
  const rows = columns[0]?.length ?? 0;
  for (let row = 0; row < rows; ++row) lines.push(columns.map((column) => String(column[row])).join(','));
  return `${lines.join('\n')}\n`;
}

const encoded = (text: string) => new TextEncoder().encode(text);
const json = (value: unknown) => encoded(`${JSON.stringify(value, null, 1)}\n`);

/** tractus-measurements/1 of one trial. */
export function probingFiles({ t_s, columns, notes }: Trial): Record<string, Uint8Array> {
  const trial = { id: 'trial1', file: 'trial1.csv', operator: '', notes };
  return {
    'set.json': json({ format: 'tractus-measurements/1', rig: 'probing', trials: [trial] }),
    'trial1.csv': encoded(
      csv(['t_s', ...columns.map(([name]) => name)], [t_s, ...columns.map(([, values]) => values)]),
    ),
  };
}

/** A group of fields with one beginning, as `wrench` or `pose`. */
export interface Group {
  readonly topic: Topic;
  readonly prefix: string;
}

const kWrench = ['force.x', 'force.y', 'force.z', 'torque.x', 'torque.y', 'torque.z'];
const kPoses = [
  ['position', 'orientation'],
  ['translation', 'rotation'],
].map(([at, turned]) => [
  ...['x', 'y', 'z'].map((axis) => `${at}.${axis}`),
  ...['w', 'x', 'y', 'z'].map((axis) => `${turned}.${axis}`),
]);

function groups(topics: readonly Topic[], wanted: readonly string[]): Group[] {
  const [first = ''] = wanted;
  return topics.flatMap((topic) => {
    const paths = new Set(topic.fields.map(({ path }) => path));
    return [...paths]
      .filter((path) => path === first || path.endsWith(`.${first}`))
      .map((path) => path.slice(0, path.length - first.length))
      .filter((prefix) => wanted.every((end) => paths.has(prefix + end)))
      .map((prefix) => ({ topic, prefix }));
  });
}

export const wrenches = (topics: readonly Topic[]) => groups(topics, kWrench);
export const poses = (topics: readonly Topic[]) => kPoses.flatMap((pose) => groups(topics, pose));

export interface Room {
  readonly wrench: Group;
  readonly tool: Group;
  readonly bone: Group | null;
}

async function body(recording: Recording, { topic, prefix }: Group, clock: Clock): Promise<Series> {
  const pose = kPoses.find((ends) => ends.every((end) => topic.fields.some(({ path }) => path === prefix + end)));
  const series = await recording.numbers(
    topic,
    (pose ?? []).map((end) => prefix + end),
    clock,
  );
  checkStamps(series);
  return series;
}

/** A row for every stamp of either body; zeros, as the format says, where a body was not seen then. */
function motionCsv(bodies: readonly (readonly [string, Series])[]): string {
  const stamps = Float64Array.from(new Set(bodies.flatMap(([, { t_s }]) => [...t_s]))).sort();
  const columns = bodies.flatMap(([, { t_s, values }]) => {
    const rowOf = new Map([...t_s].map((t, row) => [t, row]));
    return values.map((column) => stamps.map((t) => column[rowOf.get(t) ?? -1] ?? 0));
  });
  const header = bodies.flatMap(([name]) =>
    ['px_m', 'py_m', 'pz_m', 'qw', 'qx', 'qy', 'qz'].map((what) => `${name}.${what}`),
  );
  return csv(['t_s', ...header], [stamps, ...columns]);
}

/** Files for `tractus assemble`: each topic at its own stamps, nothing resampled; frames are still the identity. */
export async function roomFiles(recording: Recording, room: Room, clock: Clock): Promise<Record<string, Uint8Array>> {
  const { topic, prefix } = room.wrench;
  const force = await recording.numbers(
    topic,
    kWrench.map((end) => prefix + end),
    clock,
  );
  checkStamps(force);
  const bodies: (readonly [string, Series])[] = [['probe', await body(recording, room.tool, clock)]];
  if (room.bone) bodies.push(['vertebra', await body(recording, room.bone, clock)]);
  const identity = { p_m: [0, 0, 0], q: [1, 0, 0, 0] };
  const recipe = {
    format: 'tractus-assembly/1',
    rig: 'palpation',
    volume: 'volume.nrrd',
    tool: { body: 'probe', X_BH: identity },
    ...(room.bone ? { bone: { body: 'vertebra', X_BV: identity } } : {}),
    sensor: { X_HS: identity, says: 'on_probe' },
    tip_z_m: 0.13,
    trials: [{ id: 'trial1', motion: 'motion.csv', force: 'force.csv', operator: '', offset_s: 0 }],
  };
  return {
    'motion.csv': encoded(motionCsv(bodies)),
    'force.csv': encoded(csv(['t_s', 'fx_N', 'fy_N', 'fz_N', 'tx_Nm', 'ty_Nm', 'tz_Nm'], [force.t_s, ...force.values])),
    'assembly.json': json(recipe),
  };
}
