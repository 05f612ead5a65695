import { useEffect, useId, useRef, type ReactNode } from 'react';
import 'uplot/dist/uPlot.min.css';
import { say } from '@/language';
import { formatCount, formatTime, second } from '@/units';
import type { Cursor } from './cursor';
import { OverviewStrip } from './overview-strip';
import { isWhole, panned, whole, zoomed, type Range } from './range';
import { Moment, Readout } from './readout';
import styles from './signal-chart.module.css';
import { SignalPlot } from './signal-plot';
import type { Mark, Panel, Span } from './signal-types';
import type { Detail } from './tiles';
import { onNavigationKey, useWheel } from './use-navigation';
import { useWidth } from './use-width';

interface Props {
  readonly panels: readonly Panel[];
  readonly detail: Detail;
  /** The whole trial, coarse: the strip below. */
  readonly overview: Detail;
  readonly duration_s: number;
  readonly range: Range;
  readonly marks: readonly Mark[];
  readonly spans?: readonly Span[];
  /** What the strip below shows; without it the first trace. */
  readonly strip?: { readonly channel: string; readonly colour: string };
  readonly cursor: Cursor;
  readonly palette: number;
  /** What the chart shows, in words, for who cannot see it. */
  readonly summary: string;
  /** What the signs mean, below the chart. */
  readonly note: string;
  /** Drawn as a button by who owns the look of buttons. */
  readonly button: (label: string, sign: string, press: () => void, disabled?: boolean) => ReactNode;
  readonly onRange: (range: Range) => void;
  readonly onWidth: (width_px: number) => void;
}

const kNoSpans: readonly Span[] = [];
const kAxes_px = 64; // the ordinate's axis and the right margin: no data there

function resolution(samplesPerPoint: number): string {
  if (samplesPerPoint === 0) return say('loading');
  if (samplesPerPoint <= 1) return say('every sample');
  return say('minimum and maximum of {samples} samples', { samples: formatCount(samplesPerPoint) });
}

/** Panels over one another with one time axis, one cursor and one view. */
export function SignalChart(props: Props) {
  const {
    panels,
    detail,
    overview,
    duration_s,
    range,
    marks,
    spans = kNoSpans,
    cursor,
    palette,
    summary,
    note,
    button,
    onRange,
    onWidth,
  } = props;
  const place = useRef<HTMLDivElement>(null);
  const width = useWidth(place);
  const syncKey = useId();
  const summaryId = useId();
  const view = { range, duration_s, onRange };
  useWheel(place, view);
  useEffect(() => {
    if (width > 0) onWidth(width - kAxes_px);
  }, [width, onWidth]);

  const middle = (range.from + range.to) / 2;
  const reset = () => onRange(whole(duration_s));
  const strip = props.strip ?? panels[0]?.traces[0];
  const decimals = range.to - range.from < 1 ? 3 : 1;
  return (
    <figure className={styles.chart} aria-describedby={summaryId}>
      <div className={styles.tools}>
        <p className={styles.shown}>
          <span data-part="range" role="status">
            {formatTime(second(range.from), decimals)} – {formatTime(second(range.to), decimals)}
          </span>
          <span className={styles.resolution}>{resolution(detail.samplesPerPoint)}</span>
          <Moment cursor={cursor} />
        </p>
        <div className={styles.buttons} role="group" aria-label={say('View of the signals')}>
          {button(say('Earlier'), '←', () => onRange(panned(range, -0.25, duration_s)), range.from <= 0)}
          {button(say('Later'), '→', () => onRange(panned(range, 0.25, duration_s)), range.to >= duration_s)}
          {button(say('Zoom in'), '+', () => onRange(zoomed(range, 0.5, middle, duration_s)))}
          {button(
            say('Zoom out'),
            '−',
            () => onRange(zoomed(range, 2, middle, duration_s)),
            isWhole(range, duration_s),
          )}
          {button(say('All: show the whole trial'), say('All'), reset, isWhole(range, duration_s))}
        </div>
      </div>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <div
        ref={place}
        className={styles.panels}
        role="application"
        aria-roledescription={say('chart')}
        data-part="panels"
        aria-label={say('Signals against time. Arrow keys move and zoom, 0 shows the whole trial.')}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0}
        onKeyDown={(event) => onNavigationKey(event, view)}
      >
        {panels.map((panel, index) => (
          <div key={panel.id} data-panel={panel.id}>
            <Readout panel={panel} detail={detail} cursor={cursor} />
            <div style={{ minHeight: panel.height_px }}>
              {width === 0 ? null : (
                <SignalPlot
                  panel={panel}
                  detail={detail}
                  range={range}
                  marks={marks}
                  spans={spans}
                  cursor={cursor}
                  width_px={width}
                  withTime={index === panels.length - 1}
                  named={index === 0}
                  syncKey={syncKey}
                  palette={palette}
                  onRange={onRange}
                  onReset={reset}
                />
              )}
            </div>
          </div>
        ))}
      </div>
      {strip && width > 0 ? (
        <OverviewStrip
          detail={overview}
          channel={strip.channel}
          colour={strip.colour}
          duration_s={duration_s}
          range={range}
          width_px={width - kAxes_px}
          palette={palette}
          onRange={onRange}
        />
      ) : null}
      <p className={styles.hint}>
        {note}{' '}
        {say(
          'Drag across to zoom, drag the strip to move, double-click for the whole trial. Wheel: zoom after a click or with Ctrl, move with Shift.',
        )}
      </p>
      <figcaption id={summaryId} className="hidden-visually">
        {summary}
      </figcaption>
    </figure>
  );
}
