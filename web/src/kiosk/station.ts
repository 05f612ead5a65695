/** The station behind the page: its state comes over a WebSocket, commands go back. */
import { useEffect, useRef, useState } from 'react';
import * as v from 'valibot';

const Rig = v.picklist(['palpation', 'probing']);
export const kWalls = ['medial', 'superior', 'lateral', 'inferior', 'anterior'] as const;
export type Wall = (typeof kWalls)[number];

const Answer = v.object({
  breach: v.boolean(),
  wall: v.nullable(v.picklist(kWalls)),
  confidence: v.optional(v.number()),
  depth_m: v.optional(v.number()),
});
export type Answer = v.InferOutput<typeof Answer>;

const Work = v.object({
  assignment: v.string(),
  name: v.string(),
  number: v.number(),
  planned: v.number(),
  left: v.number(),
  rig: Rig,
  tool: v.picklist(['probe', 'burr']),
});
export type Work = v.InferOutput<typeof Work>;

export const kFaults = [
  'interrupted',
  'timed_out',
  'network',
  'locked',
  'device',
  'emergency_stop',
  'stopped',
  'work',
] as const;
export type FaultKind = (typeof kFaults)[number];

const Finding = v.object({ name: v.string(), passed: v.boolean(), words: v.string() });
export type Finding = v.InferOutput<typeof Finding>;

const Result = v.object({
  state: v.picklist(['held', 'assessing', 'assessed', 'failed']),
  correct: v.nullable(v.boolean()),
  scores: v.array(
    v.object({
      label: v.string(),
      unit: v.string(),
      shown_as: v.picklist(['number', 'share', 'correct_or_incorrect']),
      value: v.number(),
    }),
  ),
});
export type Result = v.InferOutput<typeof Result>;

const About = v.object({
  version: v.string(),
  station: v.string(),
  device: v.string(),
  limits: v.record(v.string(), v.number()),
  lowered_force_N: v.nullable(v.number()),
});
export type About = v.InferOutput<typeof About>;

const State = v.object({
  screen: v.picklist([
    'badge',
    'pin',
    'checking',
    'work',
    'preparing',
    'running',
    'answer',
    'saving',
    'result',
    'paused',
    'complete',
    'fault',
    'technician_pin',
    'technician',
    'testing',
  ]),
  simulated: v.boolean(),
  name: v.string(),
  notice: v.string(),
  waiting_trials: v.number(),
  work: v.optional(Work),
  live: v.optional(v.object({ t_s: v.number(), depth_m: v.nullable(v.number()), progress: v.nullable(v.number()) })),
  question: v.optional(v.object({ rig: Rig, length_m: v.number() })),
  outcome: v.optional(
    v.object({ answer: v.nullable(Answer), drilled: v.boolean(), sent: v.boolean(), result: v.nullable(Result) }),
  ),
  button: v.optional(v.boolean(), false),
  in_trial: v.optional(v.boolean(), false),
  technician: v.optional(v.boolean(), false),
  study: v.optional(v.boolean(), false),
  refused_badge: v.optional(v.string(), ''),
  /** That the person at the station chose on the account. */
  language: v.optional(v.string()),
  findings: v.optional(v.array(Finding), []),
  trials: v.optional(v.array(v.string()), []),
  log: v.optional(v.array(v.string()), []),
  about: v.optional(About),
  test: v.optional(v.object({ text: v.string(), waits: v.boolean() })),
  fault: v.optional(v.object({ kind: v.picklist(kFaults), what: v.string(), signed_in: v.boolean() })),
});
export type State = v.InferOutput<typeof State>;

export type Command =
  | { readonly command: 'badge'; readonly badge: string }
  | { readonly command: 'pin'; readonly pin: string }
  | { readonly command: 'answer'; readonly answer: Answer }
  | {
      readonly command:
        | 'back'
        | 'start'
        | 'end_trial'
        | 'next'
        | 'pause'
        | 'resume'
        | 'retry'
        | 'sign_out'
        | 'technician'
        | 'self_test'
        | 'confirm'
        | 'stop_test';
    };
export type Send = (command: Command) => void;

export const readState = (text: string): State => v.parse(State, JSON.parse(text));

/** open: the state is the station's. lost: it does not answer, and is asked again. elsewhere: another window has it. */
export type Connection = 'open' | 'lost' | 'elsewhere';
const kTryAgain_ms = 1000;
const kGoingAway = 1001;

/** The secret stands behind '#' in the page's address and never in a request for a page. */
const socketAddress = () => `ws://${location.host}/kiosk/live?key=${location.hash.slice(1)}`;

export function useStation(): { state: State | null; connection: Connection; send: Send; connect: () => void } {
  const [state, setState] = useState<State | null>(null);
  const [connection, setConnection] = useState<Connection>('lost');
  const [tries, setTries] = useState(0);
  const socket = useRef<WebSocket | null>(null);
  useEffect(() => {
    const opened = new WebSocket(socketAddress());
    socket.current = opened;
    let timer: ReturnType<typeof setTimeout> | undefined;
    opened.onmessage = ({ data }) => {
      setState(readState(String(data)));
      setConnection('open');
    };
    opened.onclose = ({ code }) => {
      setConnection(code === kGoingAway ? 'elsewhere' : 'lost');
      if (code !== kGoingAway) timer = setTimeout(() => setTries((n) => n + 1), kTryAgain_ms);
    };
    return () => {
      clearTimeout(timer);
      opened.onclose = null;
      opened.close();
    };
  }, [tries]);
  const send: Send = (command) => {
    if (socket.current?.readyState === WebSocket.OPEN) socket.current.send(JSON.stringify(command));
  };
  return { state, connection, send, connect: () => setTries((n) => n + 1) };
}
