/** Display names of effects, channels, runs and steps of the lab. */
import type { LabRunSummary, MeasurementSet } from '@/api';
import { effectLabels } from '@/api/generated/effect-labels';
import { formatCount, kForce, kTorque, nameAndUnit, type Quantity } from '@/units';

/** "coulomb_friction" → "Coulomb friction"; "expression:drag" → "drag (custom formula)". */
export function effectName(id: string): string {
  if (id.startsWith('expression:')) return `${id.slice('expression:'.length)} (custom formula)`;
  const words = effectLabels[id] ?? id.replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export const kEffectKinds = {
  force: { label: 'force', description: 'Adds a force to the law. Can be rendered at a station.' },
  structure: {
    label: 'structure',
    description: 'Changes the input or the response of the law. Can be rendered at a station.',
  },
  measurement: {
    label: 'measurement',
    description: 'Part of the measurement, not of the bone. Corrects the comparison; never rendered at a station.',
  },
} as const;

const kChannels: Record<string, string | undefined> = {
  fz_N: 'Axial force',
  tz_Nm: 'Twisting torque',
  force_N: 'Force',
  fx_N: 'Force, x',
  fy_N: 'Force, y',
  tx_Nm: 'Torque, x',
  ty_Nm: 'Torque, y',
  torque_Nm: 'Torque',
};

export const channelName = (channel: string) => kChannels[channel] ?? nameAndUnit(channel).name;
/** Palpation names force and torque by axis. */
export const channelNameOf = (channel: string, rig: string | null) =>
  channel === 'fz_N' && rig === 'palpation'
    ? 'Force, z'
    : channel === 'tz_Nm' && rig === 'palpation'
      ? 'Torque, z'
      : channelName(channel);
export const channelUnit = (channel: string) => nameAndUnit(channel).unit;

/** How a channel is drawn: forces and torques to the digit that a floor needs. */
export function channelQuantity(channel: string): Quantity {
  return channelUnit(channel) === 'N·m' ? { ...kTorque, decimals: 4 } : { ...kForce, decimals: 3 };
}

/** "a", "a and b", "a, b and c". */
export const joined = (words: readonly string[]) =>
  words.length < 2 ? (words[0] ?? '') : `${words.slice(0, -1).join(', ')} and ${words.at(-1) ?? ''}`;

export const setFacts = (set: MeasurementSet) =>
  [
    set.rig ?? '',
    set.trials === null ? '' : `${formatCount(set.trials)} ${set.trials === 1 ? 'trial' : 'trials'}`,
    set.samples === null ? '' : `${formatCount(set.samples)} samples`,
  ]
    .filter(Boolean)
    .join(' · ');

export const kRunLabels: Record<LabRunSummary['kind'], string> = {
  comparison: 'Comparison',
  diagnosis: 'Search for missing effects',
  fit: 'Fit',
};

export type Step = 'compare' | 'where' | 'missing' | 'add' | 'publish';
export const kSteps: readonly { id: Step; name: string }[] = [
  { id: 'compare', name: 'Compare' },
  { id: 'where', name: 'Error regions' },
  { id: 'missing', name: 'Missing effects' },
  { id: 'add', name: 'Add effects' },
  { id: 'publish', name: 'Publish' },
];
export const workAddress = (model: string, set: string, step: Step = 'compare') =>
  `/lab/work/${encodeURIComponent(model)}/${encodeURIComponent(set)}/${step}`;
export const stepOfRun: Record<LabRunSummary['kind'], Step> = {
  comparison: 'compare',
  diagnosis: 'missing',
  fit: 'add',
};
