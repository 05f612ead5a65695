import { useMemo, useState } from 'react';
import { makeCursor, SignalChart, whole, type Panel, type Range, type Span } from '@/charts';
import { say } from '@/language';
import { Button, Notice, usePalette } from '@/ui';
import { formatDuration, formatFigure, second } from '@/units';
import { useOverlay, type Side } from './use-overlay';
import { channelNameOf, channelQuantity, channelUnit, joined } from './names';

export interface Names {
  readonly before: string;
  readonly after: string | null;
}

interface Props {
  readonly run: string;
  readonly rig: string | null;
  readonly trial: { readonly id: string; readonly duration_s: number };
  readonly channel: string;
  readonly names: Names;
  /** The region whose samples are shaded; null for none. */
  readonly region?: number | null;
}

const kUsualWidth_px = 1000;
const kNoSpans: readonly Span[] = [];

function panelsOf(channel: string, rig: string | null, names: Names, noise_floor: number | null): Panel[] {
  const quantity = channelQuantity(channel),
    title = channelNameOf(channel, rig);
  const after = (series: string) =>
    names.after === null ? [] : [{ channel: series, label: names.after, colour: '--series-along' }];
  return [
    {
      id: 'value',
      title,
      quantity,
      height_px: 210,
      traces: [
        { channel: 'measured', label: say('measured'), colour: '--measured', width: 2.5 },
        { channel: 'before', label: names.before, colour: '--series-across' },
        ...after('after'),
      ],
    },
    {
      id: 'residual',
      title: say('Measured − simulated'),
      quantity,
      height_px: 140,
      fromZero: true,
      levels:
        noise_floor === null
          ? []
          : [
              { value: 2 * noise_floor, label: say('± 2 × noise') },
              { value: -2 * noise_floor, label: '' },
            ],
      traces: [
        { channel: 'before_residual', label: names.before, colour: '--series-across' },
        ...after('after_residual'),
      ],
    },
  ];
}

/** One interval of a region, with a margin to either side. */
function around(spans: readonly Span[], at: number, duration_s: number): Range {
  const span = spans[at];
  if (!span) return whole(duration_s);
  const margin = Math.max(0.5 * (span.to_s - span.from_s), 0.02 * duration_s);
  return { from: Math.max(0, span.from_s - margin), to: Math.min(duration_s, span.to_s + margin) };
}

/** Measured and simulated signals in one panel, the residual below; samples of a region are shaded. */
export function Overlay({ run, rig, trial, channel, names, region = null }: Props) {
  const [range, setRange] = useState<Range>(() => whole(trial.duration_s));
  const [width, setWidth] = useState(kUsualWidth_px);
  const [cursor] = useState(makeCursor);
  const [at, setAt] = useState(-1);
  const palette = usePalette();
  const sides = useMemo<readonly Side[]>(
    () => (names.after === null ? ['before'] : ['before', 'after']),
    [names.after],
  );
  const view = useOverlay({ run, trial: trial.id, channel, duration_s: trial.duration_s, sides }, range, width);
  const spans = region === null ? kNoSpans : (view.regions[region] ?? kNoSpans);
  const panels = useMemo(
    () => panelsOf(channel, rig, names, view.noise_floor),
    [channel, rig, names, view.noise_floor],
  );
  const goTo = (next: number) => {
    setAt(next);
    setRange(around(spans, next, trial.duration_s));
  };
  const unit = channelUnit(channel);
  const summary = say(
    '{channel} of {trial} over {duration}, measured and simulated by {models}; below, the residual, with the noise floor of {floor}.',
    {
      channel: channelNameOf(channel, rig),
      trial: trial.id,
      duration: formatDuration(second(trial.duration_s)),
      models: joined(names.after === null ? [names.before] : [names.before, names.after]),
      floor: formatFigure(view.noise_floor, unit),
    },
  );
  return (
    <>
      {view.error ? (
        <Notice tone="bad" title={say('Part of the series could not be loaded.')} onRetry={view.retry}>
          {view.error.message}
        </Notice>
      ) : null}
      {region === null ? null : (
        <p role="status" data-part="intervals">
          {spans.length === 0
            ? say('No sample of this trial is in the region.')
            : say('{count, plural, one {# interval} other {# intervals}} of this trial in the region.', {
                count: spans.length,
              })}{' '}
          {spans.length === 0 ? null : (
            <>
              <Button label={say('Previous interval in the region')} disabled={at <= 0} onClick={() => goTo(at - 1)}>
                ←
              </Button>{' '}
              <Button
                label={say('Next interval in the region')}
                disabled={at >= spans.length - 1}
                onClick={() => goTo(at + 1)}
              >
                →
              </Button>
            </>
          )}
        </p>
      )}
      <SignalChart
        panels={panels}
        detail={view.detail}
        overview={view.overview}
        duration_s={trial.duration_s}
        range={range}
        marks={[]}
        spans={spans}
        strip={{ channel: 'size', colour: '--series-across' }}
        cursor={cursor}
        palette={palette}
        summary={summary}
        note={say('The strip shows the magnitude of the residual over the whole trial.')}
        onRange={setRange}
        onWidth={setWidth}
        button={(label, sign, press, disabled) => (
          <Button label={label} onClick={press} disabled={disabled}>
            {sign}
          </Button>
        )}
      />
    </>
  );
}
