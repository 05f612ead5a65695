import { useEffect, useRef } from 'react';
import uPlot from 'uplot';
import { forgetColours } from './colour';
import type { Cursor } from './cursor';
import { plotData, plotOptions } from './plot-options';
import type { Range } from './range';
import type { Mark, Panel, Span } from './signal-types';
import type { Detail } from './tiles';

interface Props {
  readonly panel: Panel;
  readonly detail: Detail;
  readonly range: Range;
  readonly marks: readonly Mark[];
  readonly spans: readonly Span[];
  readonly cursor: Cursor;
  readonly width_px: number;
  /** The lowest panel carries the time axis, the highest the names of the marks. */
  readonly withTime: boolean;
  readonly named: boolean;
  readonly syncKey: string;
  /** Counts changes of the colours. */
  readonly palette: number;
  readonly onRange: (range: Range) => void;
  readonly onReset: () => void;
}

/** One uPlot kept over the life of the panel; only what has changed is told to it. */
export function SignalPlot({
  panel,
  detail,
  range,
  marks,
  spans,
  cursor,
  width_px,
  withTime,
  named,
  syncKey,
  palette,
  onRange,
  onReset,
}: Props) {
  const place = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const latest = useRef({ detail, range, marks, spans, cursor, onRange, onReset, width_px });
  useEffect(() => {
    latest.current = { detail, range, marks, spans, cursor, onRange, onReset, width_px };
  });

  useEffect(() => {
    if (!place.current) return;
    const now = () => latest.current;
    const options = plotOptions(panel, now().width_px, withTime, named, syncKey, {
      onRange: (next) => now().onRange(next),
      onReset: () => now().onReset(),
      onCursor: (t_s) => now().cursor.set(t_s),
      marks: () => now().marks,
      spans: () => now().spans,
    });
    const made = new uPlot(options, plotData(panel, now().detail.t, now().detail.channels), place.current);
    made.setScale('x', { min: now().range.from, max: now().range.to });
    plot.current = made;
    return () => {
      made.destroy();
      plot.current = null;
    };
  }, [panel, withTime, named, syncKey]);

  useEffect(() => {
    const drawn = plot.current;
    if (!drawn) return;
    drawn.batch(() => {
      drawn.setData(plotData(panel, detail.t, detail.channels), false);
      drawn.setScale('x', { min: latest.current.range.from, max: latest.current.range.to });
    });
  }, [panel, detail]);

  useEffect(() => {
    plot.current?.setScale('x', { min: range.from, max: range.to });
  }, [range]);
  useEffect(() => {
    forgetColours();
    plot.current?.redraw(false, true);
  }, [palette, marks, spans]);
  useEffect(() => {
    plot.current?.setSize({ width: width_px, height: plot.current.height });
  }, [width_px]);

  return <div ref={place} />;
}
