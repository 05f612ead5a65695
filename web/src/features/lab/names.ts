/** Display names of effects, channels, runs and steps of the lab. */
import type { LabRunSummary, MeasurementSet } from '@/api';
import { effectLabels } from '@/api/generated/effect-labels';
import { marked, say } from '@/language';
import { formatCount, kForce, kTorque, nameAndUnit, type Quantity } from '@/units';

/** "coulomb_friction" → "Coulomb friction"; "expression:drag" → "drag (custom formula)". */
export function effectName(id: string): string {
  if (id.startsWith('expression:')) return say('{name} (custom formula)', { name: id.slice('expression:'.length) });
  const words = say(effectLabels[id] ?? id.replaceAll('_', ' '));
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export const kEffectKinds = {
  force: { label: marked('force'), description: marked('Adds a force to the law. Can be rendered at a station.') },
  structure: {
    label: marked('structure'),
    description: marked('Changes the input or the response of the law. Can be rendered at a station.'),
  },
  measurement: {
    label: marked('measurement'),
    description: marked(
      'Part of the measurement, not of the bone. Corrects the comparison; never rendered at a station.',
    ),
  },
} as const;

const kChannels: Record<string, string | undefined> = {
  fz_N: marked('Axial force'),
  tz_Nm: marked('Twisting torque'),
  force_N: marked('Force'),
  fx_N: marked('Force, x'),
  fy_N: marked('Force, y'),
  tx_Nm: marked('Torque, x'),
  ty_Nm: marked('Torque, y'),
  torque_Nm: marked('Torque'),
};

export const channelName = (channel: string) => say(kChannels[channel] ?? nameAndUnit(channel).name);
/** Palpation names force and torque by axis. */
export const channelNameOf = (channel: string, rig: string | null) =>
  channel === 'fz_N' && rig === 'palpation'
    ? say('Force, z')
    : channel === 'tz_Nm' && rig === 'palpation'
      ? say('Torque, z')
      : channelName(channel);
export const channelUnit = (channel: string) => nameAndUnit(channel).unit;

/** How a channel is drawn: forces and torques to the digit that a floor needs. */
export function channelQuantity(channel: string): Quantity {
  return channelUnit(channel) === 'N·m' ? { ...kTorque, decimals: 4 } : { ...kForce, decimals: 3 };
}

/** "a", "a and b", "a, b and c". */
export const joined = (words: readonly string[]) =>
  words.length < 2
    ? (words[0] ?? '')
    : say('{words} and {last}', { words: words.slice(0, -1).join(', '), last: words.at(-1) ?? '' });

export const trialCount = (count: number) => say('{count, plural, one {# trial} other {# trials}}', { count });

export const setFacts = (set: MeasurementSet) =>
  [
    set.rig === null ? '' : say(set.rig),
    set.trials === null ? '' : trialCount(set.trials),
    set.samples === null ? '' : say('{count} samples', { count: formatCount(set.samples) }),
  ]
    .filter(Boolean)
    .join(' · ');

export const kRunLabels: Record<LabRunSummary['kind'], string> = {
  comparison: marked('Comparison'),
  diagnosis: marked('Search for missing effects'),
  fit: marked('Fit'),
};

export type Step = 'compare' | 'where' | 'missing' | 'add' | 'publish';
export const kSteps: readonly { id: Step; name: string }[] = [
  { id: 'compare', name: marked('Compare') },
  { id: 'where', name: marked('Error regions') },
  { id: 'missing', name: marked('Missing effects') },
  { id: 'add', name: marked('Add effects') },
  { id: 'publish', name: marked('Publish') },
];
export const workAddress = (model: string, set: string, step: Step = 'compare') =>
  `/lab/work/${encodeURIComponent(model)}/${encodeURIComponent(set)}/${step}`;
export const stepOfRun: Record<LabRunSummary['kind'], Step> = {
  comparison: 'compare',
  diagnosis: 'missing',
  fit: 'add',
};
