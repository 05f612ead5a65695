/** The lab's ids and figures in words for a person. */
import type { LabRunSummary, MeasurementSet } from '@/api';
import { formatCount, kForce, kTorque, nameAndUnit, type Quantity } from '@/units';

/** "coulomb_friction" → "Coulomb friction"; "expression:drag" → "drag (own formula)". */
export function effectName(id: string): string {
  if (id.startsWith('expression:')) return `${id.slice('expression:'.length)} (own formula)`;
  const words = id.replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export const kKind = {
  force: { word: 'force', says: 'Adds a force to the law. It can be felt at a station.' },
  structure: { word: 'structure', says: 'Changes what the law sees or how it answers. It can be felt at a station.' },
  measurement: { word: 'measurement', says: 'Belongs to how it was recorded. It corrects the comparison and is never rendered to a hand.' },
} as const;

const kChannels: Record<string, string | undefined> = {
  fz_N: 'Push along the probe', tz_Nm: 'Twisting torque', force_N: 'Force', fx_N: 'Force, x', fy_N: 'Force, y', tx_Nm: 'Torque, x', ty_Nm: 'Torque, y', torque_Nm: 'Torque',
};

export const channelName = (channel: string) => kChannels[channel] ?? nameAndUnit(channel).name;
/** A channel of palpation's force along the probe is named by its axis, not by the hand. */
export const channelNameOf = (channel: string, rig: string | null) => (channel === 'fz_N' && rig === 'palpation' ? 'Force, z' : channel === 'tz_Nm' && rig === 'palpation' ? 'Torque, z' : channelName(channel));
export const channelUnit = (channel: string) => nameAndUnit(channel).unit;

/** How a channel is drawn: forces and torques to the digit that a floor needs. */
export function channelQuantity(channel: string): Quantity {
  return channelUnit(channel) === 'N·m' ? { ...kTorque, decimals: 4 } : { ...kForce, decimals: 3 };
}

/** "a", "a and b", "a, b and c". */
export const joined = (words: readonly string[]) => (words.length < 2 ? (words[0] ?? '') : `${words.slice(0, -1).join(', ')} and ${words.at(-1) ?? ''}`);

export const setFacts = (set: MeasurementSet) =>
  [set.rig ?? '', set.trials === null ? '' : `${formatCount(set.trials)} ${set.trials === 1 ? 'trial' : 'trials'}`, set.samples === null ? '' : `${formatCount(set.samples)} samples`].filter(Boolean).join(' · ');

export const kRunWord: Record<LabRunSummary['kind'], string> = { comparison: 'Comparison', diagnosis: 'Search for what is missing', fit: 'Fit' };

export type Step = 'compare' | 'where' | 'missing' | 'add' | 'publish';
export const kSteps: readonly { id: Step; name: string }[] = [
  { id: 'compare', name: 'Compare' }, { id: 'where', name: 'Where it fails' }, { id: 'missing', name: 'What is missing' },
  { id: 'add', name: 'Add' }, { id: 'publish', name: 'Publish' },
];
export const workAddress = (model: string, set: string, step: Step = 'compare') =>
  `/lab/work/${encodeURIComponent(model)}/${encodeURIComponent(set)}/${step}`;
export const stepOfRun: Record<LabRunSummary['kind'], Step> = { comparison: 'compare', diagnosis: 'missing', fit: 'add' };
