/** A robot's recording (MCAP, as ROS 2 writes it): its topics, and the numbers of their messages over time. Loaded when one is dropped. */
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { McapIndexedReader, type Channel, type Message, type Schema } from '@mcap/core';
import { decompress as zstd } from 'fzstd';
import { decompress as lz4 } from 'lz4js';
import { say } from '@/language';
import { fieldsOf, stampOf, type Field } from './fields';

/** Of one topic. `unread`: why its messages cannot be read; it then has no fields. */
export interface Topic {
  readonly channel: number;
  readonly name: string;
  readonly schema: string;
  readonly messages: number;
  readonly fields: readonly Field[];
  readonly stamped: boolean;
  readonly unread: string | null;
}

/** Which clock says when: the sender's, in the message's header, or that of the program that recorded. */
export type Clock = 'header' | 'log';

/** Rows in the order of the recording. Time is from the first message of the recording. */
export interface Numbers {
  readonly topic: string;
  readonly t_s: Float64Array;
  /** By field, in the order asked for. */
  readonly values: readonly Float64Array[];
}

export interface Recording {
  readonly name: string;
  readonly topics: readonly Topic[];
  numbers(topic: Topic, paths: readonly string[], clock: Clock): Promise<Numbers>;
}

type Decode = (data: Uint8Array) => unknown;

// The lab takes so many rows of a trial.
const kMostMessages = 10_000_000;
// A chunk's stated size is believed up to here: rosbag2 writes 0.75 MiB, others up to some tens.
const kMostChunk_bytes = 512 * 1024 * 1024;

/** Errors of the libraries are English and for programmers: the person learns which file it was and what to try. */
async function orDamaged<T>(file: string, read: () => Promise<T>): Promise<T> {
  try {
    return await read();
  } catch (failure) {
    if (failure instanceof Told) throw failure;
    const why = failure instanceof Error ? (failure.message.split('\n')[0] ?? '') : '';
    throw new Told(
      say(
        '{file} cannot be read as an MCAP recording ({why}). If its recording was cut short, “mcap recover” repairs it.',
        {
          file,
          why: why.slice(0, 120),
        },
      ),
    );
  }
}

/** A sentence for the person. */
class Told extends Error {}

function decoded(compressed: Uint8Array, size: bigint, how: (bytes: Uint8Array, size: number) => Uint8Array) {
  if (size > kMostChunk_bytes) throw new Error(`a chunk of ${size} bytes`);
  return how(compressed, Number(size));
}
const kDecompress = {
  lz4: (bytes: Uint8Array, size: bigint) => decoded(bytes, size, (part, most) => lz4(part, most)),
  zstd: (bytes: Uint8Array, size: bigint) => decoded(bytes, size, (part, most) => zstd(part, new Uint8Array(most))),
};

function readable(file: Blob) {
  return {
    size: () => Promise.resolve(BigInt(file.size)),
    read: async (offset: bigint, size: bigint) => {
      if (offset + size > BigInt(file.size)) throw new Error('ends early');
      return new Uint8Array(await file.slice(Number(offset), Number(offset + size)).arrayBuffer());
    },
  };
}

/** How a channel's messages are decoded, or why they are not. */
function decoderOf({ messageEncoding }: Channel, schema: Schema | undefined): Decode | string {
  if (messageEncoding === 'json') {
    const text = new TextDecoder();
    return (data) => JSON.parse(text.decode(data)) as unknown;
  }
  if (messageEncoding === 'cdr' && schema?.encoding === 'ros2msg') {
    const reader = new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true }));
    return (data) => reader.readMessage(data);
  }
  return say('{encoding} messages are not read: ROS 2 messages (cdr with ros2msg) and json are', {
    encoding: [messageEncoding, schema?.encoding].filter(Boolean).join(' / ') || '?',
  });
}

async function* messagesOf(reader: McapIndexedReader, { id, topic }: Channel): AsyncGenerator<Message> {
  for await (const message of reader.readMessages({ topics: [topic], validateCrcs: true }))
    if (message.channelId === id) yield message;
}

async function topicOf(reader: McapIndexedReader, channel: Channel): Promise<Topic> {
  const schema = reader.schemasById.get(channel.schemaId);
  const about = {
    channel: channel.id,
    name: channel.topic,
    schema: schema?.name ?? '',
    messages: Number(reader.statistics?.channelMessageCounts.get(channel.id) ?? 0n),
  };
  const unread = (why: string): Topic => ({ ...about, fields: [], stamped: false, unread: why });
  const decode = decoderOf(channel, schema);
  if (typeof decode === 'string') return unread(decode);
  for await (const { data } of messagesOf(reader, channel)) {
    try {
      const first = decode(data);
      return { ...about, fields: fieldsOf(first, about.schema), stamped: stampOf(first) !== null, unread: null };
    } catch {
      return unread(say('its messages do not fit their definition'));
    }
  }
  return unread(say('no messages'));
}

/** Errors: a sentence for the person who dropped the file. */
export async function openRecording(file: File): Promise<Recording> {
  const { name } = file;
  return orDamaged(name, async () => {
    const reader = await McapIndexedReader.Initialize({ readable: readable(file), decompressHandlers: kDecompress });
    const start_ns = reader.statistics?.messageStartTime ?? 0n;
    const topics: Topic[] = [];
    for (const channel of reader.channelsById.values()) topics.push(await topicOf(reader, channel));
    topics.sort((a, b) => a.name.localeCompare(b.name));
    return {
      name,
      topics,
      numbers: (topic, paths, clock) => orDamaged(name, () => numbersOf(reader, topic, { paths, clock, start_ns })),
    };
  });
}

interface Asked {
  readonly paths: readonly string[];
  readonly clock: Clock;
  readonly start_ns: bigint;
}

async function numbersOf(reader: McapIndexedReader, topic: Topic, { paths, clock, start_ns }: Asked): Promise<Numbers> {
  const channel = reader.channelsById.get(topic.channel);
  if (!channel) throw new Error('no such channel');
  const decode = decoderOf(channel, reader.schemasById.get(channel.schemaId));
  if (typeof decode === 'string') throw new Told(decode);
  const fields = paths.map((path) => topic.fields.find((field) => field.path === path));
  const t_s: number[] = [];
  const values: number[][] = paths.map(() => []);
  for await (const { data, logTime } of messagesOf(reader, channel)) {
    if (t_s.length >= kMostMessages)
      throw new Told(say('{topic}: more than {count} messages', { topic: topic.name, count: kMostMessages }));
    const message = decode(data);
    const ns = clock === 'log' ? logTime : stampOf(message);
    if (ns === null)
      throw new Told(say('{topic}: message {n} has no time in its header', { topic: topic.name, n: t_s.length + 1 }));
    t_s.push(Number(ns - start_ns) / 1e9);
    for (const [i, field] of fields.entries()) {
      const value = field?.read(message);
      if (value === undefined || !Number.isFinite(value))
        throw new Told(
          say('{topic}: message {n} has no number {field}', {
            topic: topic.name,
            n: t_s.length,
            field: paths[i] ?? '',
          }),
        );
      values[i]?.push(value);
    }
  }
  return { topic: topic.name, t_s: Float64Array.from(t_s), values: values.map((column) => Float64Array.from(column)) };
}
