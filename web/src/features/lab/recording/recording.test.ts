// @vitest-environment node
/** Recordings written by the formats' own writers (@mcap/core, @foxglove/rosmsg2-serialization). SIMULATED. */
import { parse } from '@foxglove/rosmsg';
import { MessageWriter } from '@foxglove/rosmsg2-serialization';
import { McapWriter, type McapWriterOptions } from '@mcap/core';
import { File as NodeFile } from 'node:buffer';
import { compress as lz4 } from 'lz4js';
import { beforeAll, describe, expect, it } from 'vitest';
import { joined } from './join';
import { poses, probingFiles, probingTrial, roomFiles, wrenches, type Chosen } from './made';
import { openRecording, type Recording } from './mcap';

// common_interfaces (ROS 2): the messages' own definitions.
const kHeader = `================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec`;
const kVector = `================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z`;
const kWrenchStamped = `std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
${kVector}
${kHeader}`;
const kJointState = `std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
${kHeader}`;
const kPoseStamped = `std_msgs/Header header
geometry_msgs/Pose pose
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
${kHeader}`;

const kStart_s = 1_700_000_000;
const header = (t_s: number) => ({
  stamp: { sec: kStart_s + Math.floor(t_s), nanosec: Math.round((t_s - Math.floor(t_s)) * 1e9) },
  frame_id: 'rig',
});
const vector = (x: number, y: number, z: number) => ({ x, y, z });

interface Sent {
  readonly topic: string;
  readonly t_s: number;
  readonly message: unknown;
}
/** Force 2 − 3 t at 1 kHz, the joint's angle 0.5 t and depth 0.01 t at 100 Hz, a pose, a depth as JSON in mm. */
function simulated(without: (sent: Sent) => boolean): Sent[] {
  const sent: Sent[] = [];
  for (let i = 0; i <= 1000; ++i) {
    const t_s = i / 1000;
    const wrench = { force: vector(0.1, 0.2, 2 - 3 * t_s), torque: vector(0, 0, 0.02 * t_s) };
    sent.push({ topic: '/force', t_s, message: { header: header(t_s), wrench } });
    if (i % 10 !== 5) continue;
    const joint = { name: ['turn', 'slide'], position: [0.5 * t_s, 0.01 * t_s], velocity: [], effort: [] };
    const turned = i % 20 === 5 ? joint : { ...joint, name: ['slide', 'turn'], position: [0.01 * t_s, 0.5 * t_s] };
    sent.push({ topic: '/joints', t_s, message: { header: header(t_s), ...turned } });
    const pose = { position: vector(t_s, 0, 1), orientation: { x: 0, y: 0, z: 0.6, w: 0.8 } };
    sent.push({ topic: '/probe', t_s, message: { header: header(t_s), pose } });
    sent.push({ topic: '/depth', t_s, message: { header: header(t_s), depth_mm: 10 * t_s } });
  }
  return sent.filter((one) => !without(one));
}

class Memory {
  parts: Uint8Array[] = [];
  length = 0n;
  position = () => this.length;
  write = (bytes: Uint8Array) => {
    this.parts.push(bytes.slice());
    this.length += BigInt(bytes.length);
    return Promise.resolve();
  };
}

type Compress = NonNullable<McapWriterOptions['compressChunk']>;

async function written(
  without: (sent: Sent) => boolean = () => false,
  compressChunk: Compress | null = null,
): Promise<Uint8Array> {
  const memory = new Memory();
  const writer = new McapWriter({
    writable: memory,
    ...(compressChunk ? { compressChunk } : {}),
  });
  await writer.start({ profile: 'ros2', library: 'test' });
  const ros = async (topic: string, name: string, text: string) => {
    const schemaId = await writer.registerSchema({ name, encoding: 'ros2msg', data: new TextEncoder().encode(text) });
    const id = await writer.registerChannel({ schemaId, topic, messageEncoding: 'cdr', metadata: new Map() });
    const encoder = new MessageWriter(parse(text, { ros2: true }));
    return [topic, { id, encode: (message: unknown) => encoder.writeMessage(message) }] as const;
  };
  const jsonChannel = await writer.registerChannel({
    schemaId: 0,
    topic: '/depth',
    messageEncoding: 'json',
    metadata: new Map(),
  });
  await writer.registerChannel({ schemaId: 0, topic: '/other', messageEncoding: 'protobuf', metadata: new Map() });
  const channels = new Map([
    await ros('/force', 'geometry_msgs/msg/WrenchStamped', kWrenchStamped),
    await ros('/joints', 'sensor_msgs/msg/JointState', kJointState),
    await ros('/probe', 'geometry_msgs/msg/PoseStamped', kPoseStamped),
    [
      '/depth',
      { id: jsonChannel, encode: (message: unknown) => new TextEncoder().encode(JSON.stringify(message)) },
    ] as const,
  ]);
  for (const [sequence, { topic, t_s, message }] of simulated(without).entries()) {
    const channel = channels.get(topic);
    if (!channel) throw new Error(topic);
    const logTime = BigInt(kStart_s) * 1_000_000_000n + BigInt(Math.round((t_s + 0.25) * 1e9)); // it came 0.25 s later
    await writer.addMessage({
      channelId: channel.id,
      sequence,
      logTime,
      publishTime: logTime,
      data: channel.encode(message),
    });
  }
  await writer.end();
  return new Uint8Array(await new Blob(memory.parts as Uint8Array<ArrayBuffer>[]).arrayBuffer());
}

/** A Zstandard frame of raw blocks alone (RFC 8878, sections 3.1.1.1 and 3.1.1.2), by hand. */
function zstdOfRawBlocks(data: Uint8Array): Uint8Array {
  const kBlock = 128 * 1024;
  const out: Uint8Array[] = [
    Uint8Array.of(0x28, 0xb5, 0x2f, 0xfd, 0xa0),
    new Uint8Array(Uint32Array.of(data.length).buffer),
  ];
  for (let at = 0; at < data.length; at += kBlock) {
    const block = data.subarray(at, at + kBlock);
    const head = (block.length << 3) | (at + kBlock >= data.length ? 1 : 0);
    out.push(Uint8Array.of(head & 255, (head >> 8) & 255, head >> 16), block);
  }
  return Uint8Array.from(out.flatMap((part) => [...part]));
}

const fileOf = (bytes: Uint8Array) => new NodeFile([bytes as Uint8Array<ArrayBuffer>], 'run.mcap') as unknown as File;
const topic = (recording: Recording, name: string) => {
  const found = recording.topics.find((one) => one.name === name);
  if (!found) throw new Error(name);
  return found;
};
const chosen = (recording: Recording, name: string, path: string, unit: string, more = {}): Chosen => ({
  topic: topic(recording, name),
  path,
  unit,
  zero: 0,
  reversed: false,
  ...more,
});
const kWhole = { clock: 'header', from_s: -Infinity, to_s: Infinity } as const;

let bytes: Uint8Array;
let recording: Recording;
beforeAll(async () => {
  bytes = await written();
  recording = await openRecording(fileOf(bytes));
});

describe('a recording', () => {
  it('shows its topics with the numbers in them and their units', () => {
    expect(recording.topics.map(({ name, messages }) => [name, messages])).toEqual([
      ['/depth', 100],
      ['/force', 1001],
      ['/joints', 100],
      ['/other', 0],
      ['/probe', 100],
    ]);
    const fields = (name: string) => topic(recording, name).fields.map(({ path, unit }) => [path, unit]);
    expect(fields('/force')).toContainEqual(['wrench.force.z', 'N']);
    expect(fields('/probe')).toContainEqual(['pose.orientation.w', '1']);
    expect(fields('/joints')).toEqual([
      ['position[turn]', 'rad or m'],
      ['position[slide]', 'rad or m'],
    ]);
    expect(fields('/depth')).toEqual([['depth_mm', null]]);
    expect(topic(recording, '/other').unread).toMatch(/^protobuf messages are not read/);
  });

  it('gives a joint its own numbers, whatever order the messages have', async () => {
    const { t_s, values } = await recording.numbers(topic(recording, '/joints'), ['position[slide]'], 'header');
    for (const [i, t] of t_s.entries()) expect(values[0]?.[i]).toBeCloseTo(0.01 * (t + 0.25), 9);
  });

  it.each([
    ['lz4', lz4],
    ['zstd', zstdOfRawBlocks],
  ] as const)('is read where its chunks are compressed by %s', async (compression, compress) => {
    const file = await written(
      () => false,
      (data) => ({ compression, compressedData: compress(data) }),
    );
    const packed = await openRecording(fileOf(file));
    const { values } = await packed.numbers(topic(packed, '/force'), ['wrench.force.z'], 'log');
    expect(values[0]?.[500]).toBeCloseTo(0.5, 12);
  });

  it('that is no MCAP, is cut short or damaged is refused in one line', async () => {
    const cut = bytes.slice(0, bytes.length / 2);
    for (const bad of [new Uint8Array(0), new TextEncoder().encode('t_s,x_m\n'.repeat(100)), cut])
      await expect(openRecording(fileOf(bad))).rejects.toThrow(
        /^run\.mcap cannot be read as an MCAP recording \([^\n]*$/,
      );
    const damaged = bytes.slice();
    for (let i = 2000; i < bytes.length / 3; i += 97) damaged[i] = (damaged[i] ?? 0) ^ 0xff;
    const opened = openRecording(fileOf(damaged)).then(async (one) => {
      for (const each of one.topics) if (each.fields[0]) await one.numbers(each, [each.fields[0].path], 'log');
    });
    await expect(opened).rejects.toThrow(/^run\.mcap cannot be read/);
  });
});

describe('a set of the probing rig', () => {
  it('has the force at its own stamps and the rest on straight lines between theirs', async () => {
    const trial = await probingTrial(
      recording,
      {
        x_m: chosen(recording, '/depth', 'depth_mm', 'mm', { zero: 2 }),
        theta_rad: chosen(recording, '/joints', 'position[turn]', 'rad'),
        fz_N: chosen(recording, '/force', 'wrench.force.z', 'N', { reversed: true }),
      },
      kWhole,
    );
    // The depth is recorded from 0.005 s to 0.995 s: 991 stamps of the force lie within.
    expect(trial.t_s.length).toBe(991);
    const column = new Map(trial.columns);
    for (const [i, t] of trial.t_s.entries()) {
      const at_s = t + 0.005;
      expect(column.get('fz_N')?.[i]).toBeCloseTo(-(2 - 3 * at_s), 6);
      expect(column.get('x_m')?.[i]).toBeCloseTo((10 * at_s - 2) * 1e-3, 9);
      expect(column.get('theta_rad')?.[i]).toBeCloseTo(0.5 * at_s, 7);
    }
    const files = probingFiles(trial);
    const text = new TextDecoder();
    expect(JSON.parse(text.decode(files['set.json']))).toMatchObject({
      format: 'tractus-measurements/1',
      rig: 'probing',
      trials: [{ id: 'trial1', file: 'trial1.csv' }],
    });
    const [first, second] = text.decode(files['trial1.csv']).split('\n');
    expect(first).toBe('t_s,x_m,theta_rad,fz_N');
    expect(second?.split(',').map(Number)[0]).toBe(0);
    expect(trial.notes).toContain('x_m: /depth depth_mm (mm, zero at 2)');
    expect(trial.notes).toContain('/joints interpolated linearly at the stamps of /force');
  });

  it('is refused at a gap, which a part of the recording can leave out', async () => {
    const withGap = await openRecording(
      fileOf(await written(({ topic: of, t_s }) => of === '/depth' && t_s > 0.4 && t_s < 0.6)),
    );
    const choices = {
      x_m: chosen(withGap, '/depth', 'depth_mm', 'mm'),
      fz_N: chosen(withGap, '/force', 'wrench.force.z', 'N'),
    };
    await expect(probingTrial(withGap, choices, kWhole)).rejects.toThrow(/^\/depth has a gap of 0\.210.s at 0\.145.s/);
    // By the clock of the recording, which begins 0.25 s after the first stamp.
    const part = await probingTrial(withGap, choices, { ...kWhole, to_s: 0.14 });
    expect(part.t_s.length).toBe(386); // from 0.005 s to 0.390 s of the force's stamps
  });

  it('is refused where topics have no common time or time runs back', () => {
    const series = (name: string, t_s: readonly number[]) => ({
      topic: name,
      t_s: Float64Array.from(t_s),
      values: [Float64Array.from(t_s)],
    });
    expect(() => joined(series('/a', [0, 1]), [series('/b', [2, 3])])).toThrow('The topics have no common time');
    expect(() => joined(series('/a', [0, 1, 1]), [])).toThrow('/a: the time of message 3 is not later');
    expect(() => joined(series('/a', [0]), [])).toThrow('/a has fewer than two messages');
  });
});

describe('files for the measuring room', () => {
  it('have each topic at its own stamps, and zeros where a body was not seen', async () => {
    const late = await openRecording(fileOf(await written()));
    const [wrench] = wrenches(late.topics);
    const [tool] = poses(late.topics);
    if (!wrench || !tool) throw new Error('no wrench or no pose');
    expect([wrench.prefix, tool.prefix]).toEqual(['wrench.', 'pose.']);
    const files = await roomFiles(late, { wrench, tool, bone: null }, 'header');
    const text = new TextDecoder();
    const motion = text.decode(files['motion.csv']).trimEnd().split('\n');
    expect(motion[0]).toBe('t_s,probe.px_m,probe.py_m,probe.pz_m,probe.qw,probe.qx,probe.qy,probe.qz');
    expect(motion.length).toBe(101);
    expect(motion[1]?.split(',').map(Number)).toEqual([-0.245, 0.005, 0, 1, 0.8, 0, 0, 0.6]);
    const force = text.decode(files['force.csv']).trimEnd().split('\n');
    expect(force.length).toBe(1002);
    expect(force[1001]?.split(',').map(Number)).toEqual([0.75, 0.1, 0.2, -1, 0, 0, 0.02]);
    expect(JSON.parse(text.decode(files['assembly.json']))).toMatchObject({ trials: [{ offset_s: 0 }] });
  });
});
