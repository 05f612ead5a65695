/** What is drawn against time, and in what words it is told. */
import { kChannels, kProbingChannels, type Channel, type Trial } from '@/api';
import type { Detail, Mark, Panel } from '@/charts';
import { marked, say } from '@/language';
import { formatDuration, formatTime, kAngle, kForce, kLength, kSpeed, kTorque, second, withUnit } from '@/units';

const kPalpation: readonly Panel[] = [
  {
    id: 'force',
    title: marked('Force on the probe'),
    quantity: kForce,
    height_px: 170,
    fromZero: true,
    traces: [
      { channel: 'force_xy_N', label: marked('transverse'), symbol: ['F', 'xy'], colour: '--series-across' },
      { channel: 'force_z_N', label: marked('axial'), symbol: ['F', 'z'], colour: '--series-along' },
    ],
  },
  {
    id: 'torque',
    title: marked('Torque on the probe'),
    quantity: kTorque,
    height_px: 130,
    fromZero: true,
    traces: [
      { channel: 'torque_xy_Nm', label: marked('bending'), symbol: ['T', 'xy'], colour: '--series-across' },
      { channel: 'torque_z_Nm', label: marked('twisting'), symbol: ['T', 'z'], colour: '--series-along' },
    ],
  },
  {
    id: 'place',
    title: marked('Tip position in the tract'),
    quantity: kLength,
    height_px: 130,
    fromZero: true,
    traces: [
      { channel: 'depth_m', label: marked('depth'), colour: '--series-third' },
      { channel: 'offset_m', label: marked('offset from the axis'), colour: '--series-across' },
    ],
  },
  {
    id: 'tilt',
    title: marked('Angle of the shank to the axis'),
    quantity: kAngle,
    height_px: 90,
    fromZero: true,
    traces: [{ channel: 'angle_rad', label: marked('angle'), colour: '--series-along' }],
  },
];

const kProbing: readonly Panel[] = [
  {
    id: 'force',
    title: marked('Hand force'),
    quantity: kForce,
    height_px: 170,
    fromZero: true,
    traces: [{ channel: 'force_N', label: marked('force'), symbol: ['F', 'z'], colour: '--series-along' }],
  },
  {
    id: 'depth',
    title: marked('Tip depth'),
    quantity: kLength,
    height_px: 130,
    fromZero: true,
    traces: [{ channel: 'depth_m', label: marked('depth'), colour: '--series-third' }],
  },
  {
    id: 'speed',
    title: marked('Velocity into the bone'),
    quantity: kSpeed,
    height_px: 130,
    fromZero: true,
    traces: [{ channel: 'speed_m_s', label: marked('velocity'), colour: '--series-across' }],
  },
  {
    id: 'turn',
    title: marked('Rotation of the probe'),
    quantity: kAngle,
    height_px: 90,
    fromZero: true,
    traces: [{ channel: 'angle_rad', label: marked('angle'), colour: '--series-along' }],
  },
];

interface SignalSet {
  readonly panels: readonly Panel[];
  readonly channels: readonly Channel[];
  readonly note: string;
}

const kSets: Record<Trial['rig'], SignalSet> = {
  palpation: {
    panels: kPalpation,
    channels: kChannels,
    note: marked(
      'Forces and torques act from the bone on the probe, in the frame of its handle: a negative axial force pushes the probe out of the tract.',
    ),
  },
  probing: {
    panels: kProbing,
    channels: kProbingChannels,
    note: marked(
      'The force acts from the hand on the probe; the depth is the distance of the tip from the entry. Both are positive into the bone.',
    ),
  },
};

/** In the reader's language. */
export function setOf(rig: Trial['rig']): SignalSet {
  const { panels, channels, note } = kSets[rig];
  return {
    panels: panels.map((panel) => ({
      ...panel,
      title: say(panel.title),
      traces: panel.traces.map((trace) => ({ ...trace, label: say(trace.label) })),
    })),
    channels,
    note: say(note),
  };
}

/** Start and end are the ends of the axis and need no mark; the zero that was taken off the sensor is no moment of the hand. */
const kUnmarked: readonly string[] = ['start', 'end', 'tare'];

export function marksOf(trial: Trial): Mark[] {
  return trial.events.filter(({ kind }) => !kUnmarked.includes(kind)).map(({ t_s, kind }) => ({ t_s, label: kind }));
}

function strongest(detail: Detail, channel: string): { value: number; t: number } | null {
  const envelope = detail.channels[channel];
  let found: { value: number; t: number } | null = null;
  envelope?.max.forEach((greatest, i) => {
    for (const value of [greatest, envelope.min[i] ?? null]) {
      if (value !== null && Math.abs(value) > Math.abs(found?.value ?? 0)) found = { value, t: detail.t[i] ?? 0 };
    }
  });
  return found;
}

/** The chart for who does not see it: the peaks, when they were, and the events. */
export function summaryOf(trial: Trial, overview: Detail): string {
  const peaks = setOf(trial.rig)
    .panels.flatMap((panel) =>
      panel.traces.map((trace) => {
        const peak = strongest(overview, trace.channel);
        return peak
          ? say('{panel}, {trace}: up to {peak} at {time}', {
              panel: panel.title,
              trace: trace.label,
              peak: withUnit(peak.value, panel.quantity),
              time: formatTime(second(peak.t), 1),
            })
          : '';
      }),
    )
    .filter(Boolean);
  const events = trial.events.map((event) =>
    say('{event} at {time}', { event: event.kind, time: formatTime(event.t_s, 1) }),
  );
  return say('Signals over {duration}. {peaks}. Events: {events}. The numbers are in the table of measures.', {
    duration: formatDuration(trial.duration_s),
    peaks: peaks.join('. '),
    events: events.join(', ') || say('none'),
  });
}
