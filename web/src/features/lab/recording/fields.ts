/** The numbers in a message, by path, and the unit that the message's definition gives them. */

export interface Field {
  /** As `wrench.force.z` or, of an array that the message names, `position[wrist]`. */
  readonly path: string;
  /** By the definition of the message (ROS REP 103 for the common ones); null where it gives none. */
  readonly unit: string | null;
  readonly read: (message: unknown) => number | undefined;
}

type Read = (message: unknown) => unknown;
const kMostDepth = 8,
  kMostElements = 64;

const member = (of: unknown, key: string): unknown =>
  typeof of === 'object' && of !== null ? (of as Record<string, unknown>)[key] : undefined;

function numberIn(value: unknown): number | undefined {
  return typeof value === 'number' ? value : typeof value === 'bigint' ? Number(value) : undefined;
}

/** Units of what ends so, in messages of geometry_msgs, sensor_msgs and nav_msgs (their .msg files; REP 103: SI). */
const kUnits: readonly (readonly [RegExp, string])[] = [
  [/(^|\.)force\.[xyz]$/, 'N'],
  [/(^|\.)torque\.[xyz]$/, 'Nm'],
  [/(^|\.)(position|translation|point)\.[xyz]$/, 'm'],
  [/(^|\.)(orientation|rotation)\.[xyzw]$/, '1'],
  [/(^|\.)linear\.[xyz]$/, 'm/s'],
  [/(^|\.)(angular|angular_velocity)\.[xyz]$/, 'rad/s'],
  [/(^|\.)linear_acceleration\.[xyz]$/, 'm/s²'],
];
/** A joint turns or slides: its definition leaves the unit open between these. */
const kJoint: readonly (readonly [RegExp, string])[] = [
  [/^position\[/, 'rad or m'],
  [/^velocity\[/, 'rad/s or m/s'],
  [/^effort\[/, 'Nm or N'],
];
const kStated = /^(geometry_msgs|sensor_msgs|nav_msgs)\//;

function unitOf(path: string, schema: string): string | null {
  if (!kStated.test(schema)) return null;
  const table = /\bJointState$/.test(schema) ? kJoint : kUnits;
  return table.find(([end]) => end.test(path))?.[1] ?? null;
}

const isArray = (value: unknown): value is ArrayLike<unknown> => Array.isArray(value) || ArrayBuffer.isView(value);

/** Elements by their names where the message has as many (sensor_msgs/JointState), else by number. */
function elements(array: ArrayLike<unknown>, names: unknown): { label: string; at: (owner: unknown) => number }[] {
  if (array.length > kMostElements) return []; // a picture, a scan, a cloud
  const named = Array.isArray(names) && names.length === array.length && new Set(names).size === names.length;
  return Array.from({ length: array.length }, (_, i) => {
    const name: unknown = named ? names[i] : null;
    if (typeof name !== 'string') return { label: String(i), at: () => i };
    return {
      label: name,
      at: (owner) => {
        const now = member(owner, 'name'); // the order may change from message to message
        return Array.isArray(now) ? now.indexOf(name) : -1;
      },
    };
  });
}

function walk(value: unknown, path: string, read: Read, depth: number, found: [string, Read][]) {
  if (numberIn(value) !== undefined) found.push([path, read]);
  if (depth === 0 || typeof value !== 'object' || value === null || isArray(value)) return;
  for (const [key, inner] of Object.entries(value)) {
    const here = path === '' ? key : `${path}.${key}`;
    const own: Read = (message) => member(read(message), key);
    if (!isArray(inner)) walk(inner, here, own, depth - 1, found);
    else
      for (const { label, at } of elements(inner, member(value, 'name')))
        walk(
          inner[Number(at(value))],
          `${here}[${label}]`,
          (message) => {
            const owner = read(message);
            const array = member(owner, key);
            return isArray(array) ? array[at(owner)] : undefined;
          },
          depth - 1,
          found,
        );
  }
}

/** Every number of a first message but its header's. */
export function fieldsOf(first: unknown, schema: string): Field[] {
  const found: [string, Read][] = [];
  walk(first, '', (message) => message, kMostDepth, found);
  return found
    .filter(([path]) => !/^header\./.test(path))
    .map(([path, read]) => ({ path, unit: unitOf(path, schema), read: (message) => numberIn(read(message)) }));
}

/** The time in a message's header, in nanoseconds of its sender's clock; null where it has none. */
export function stampOf(message: unknown): bigint | null {
  const stamp = member(member(message, 'header'), 'stamp');
  const sec = numberIn(member(stamp, 'sec')),
    nanosec = numberIn(member(stamp, 'nanosec')) ?? numberIn(member(stamp, 'nsec'));
  if (sec === undefined || nanosec === undefined || !Number.isInteger(sec) || !Number.isInteger(nanosec)) return null;
  return BigInt(sec) * 1_000_000_000n + BigInt(nanosec);
}
