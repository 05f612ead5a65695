/** Sentences about the channel that a burr drilled, from the measures of the trial. */
import type { Metric } from '@/api';
import { say } from '@/language';
import { formatMeasure, kNone } from '@/units';

export interface Channel {
  readonly outcome: 'within' | 'out' | 'unknown';
  readonly headline: string;
  readonly entry: string;
  readonly direction: string;
  readonly end: string;
  readonly removed: string;
}

/** Null for a trial that did not drill, or that is not measured yet. */
export function channelOf(metrics: readonly Metric[]): Channel | null {
  const byId = new Map(metrics.map((metric) => [metric.id, metric]));
  if (!byId.has('drilled_volume')) return null;
  const shown = (id: string): string => {
    const metric = byId.get(id);
    return metric && metric.value !== null ? formatMeasure(metric.value, metric.unit) : kNone;
  };
  const beyond = byId.get('channel_breach');
  const rest = {
    entry: shown('channel_entry_offset'),
    direction: shown('channel_angle'),
    end: shown('channel_beyond_end'),
    removed: shown('drilled_volume'),
  };
  if (!beyond || beyond.value === null)
    return {
      outcome: 'unknown',
      headline: beyond ? say('Not assessed: {why}', { why: say(beyond.note) }) : say('The channel was not measured'),
      ...rest,
    };
  const by = formatMeasure(Math.abs(beyond.value), beyond.unit);
  return beyond.value > 0
    ? {
        outcome: 'out',
        headline: say('Left the bone, {where}, by {distance}', { where: say(beyond.note), distance: by }),
        ...rest,
      }
    : {
        outcome: 'within',
        headline: say('Within the bone: {distance} of bone remains, {where}', {
          distance: by,
          where: say(beyond.note),
        }),
        ...rest,
      };
}
