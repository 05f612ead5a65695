/** How uPlot draws one panel: band from least to greatest, marks, axes in the display unit. */
import uPlot from 'uplot';
import { tickLabels } from '@/units';
import { resolved } from './colour';
import type { Range } from './range';
import type { Mark, Panel, Span } from './signal-types';

export interface PlotEvents {
  readonly onRange: (range: Range) => void;
  readonly onReset: () => void;
  readonly onCursor: (t_s: number | null) => void;
  readonly marks: () => readonly Mark[];
  readonly spans: () => readonly Span[];
}

const kAxis_px = 54;
const kFont = '11px system-ui, sans-serif';
export const kTimeAxis_px = 30;

function drawMarks(plot: uPlot, marks: readonly Mark[], named: boolean): void {
  const { ctx, bbox } = plot;
  const { min = 0, max = 0 } = plot.scales.x ?? {};
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = resolved('--event');
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textBaseline = 'top';
  for (const mark of marks) {
    if (mark.t_s < min || mark.t_s > max) continue;
    const x = Math.round(plot.valToPos(mark.t_s, 'x', true));
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    if (!named) continue;
    const right = x > bbox.left + bbox.width * 0.9;
    ctx.textAlign = right ? 'right' : 'left';
    ctx.fillText(mark.label, x + (right ? -4 : 4) * devicePixelRatio, bbox.top + 2 * devicePixelRatio);
  }
  ctx.restore();
}

function drawSpans(plot: uPlot, spans: readonly Span[]): void {
  const { ctx, bbox } = plot;
  const { min = 0, max = 0 } = plot.scales.x ?? {};
  ctx.save();
  ctx.fillStyle = resolved('--span');
  for (const span of spans) {
    if (span.to_s < min || span.from_s > max) continue;
    const from = plot.valToPos(Math.max(span.from_s, min), 'x', true),
      to = plot.valToPos(Math.min(span.to_s, max), 'x', true);
    ctx.fillRect(from, bbox.top, Math.max(to - from, devicePixelRatio), bbox.height);
  }
  ctx.restore();
}

function drawLevels(plot: uPlot, panel: Panel): void {
  const { ctx, bbox } = plot;
  const { min = 0, max = 0 } = plot.scales.y ?? {};
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = resolved('--text-muted');
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = 'right';
  ctx.textBaseline = 'bottom';
  for (const level of panel.levels ?? []) {
    const value = level.value * panel.quantity.perSi;
    if (value < min || value > max) continue;
    const y = Math.round(plot.valToPos(value, 'y', true));
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.fillText(level.label, bbox.left + bbox.width - 4 * devicePixelRatio, y - 2 * devicePixelRatio);
  }
  ctx.restore();
}

function axes(withTime: boolean): uPlot.Axis[] {
  const common = {
    font: kFont,
    stroke: () => resolved('--text-muted'),
    grid: { stroke: () => resolved('--grid'), width: 1 },
    ticks: { stroke: () => resolved('--grid'), width: 1, size: 4 },
  };
  return [
    {
      ...common,
      size: withTime ? kTimeAxis_px : 0,
      space: 70,
      values: (_plot, ticks, _axis, _space, step) =>
        withTime ? tickLabels(ticks, step).map((text) => `${text} s`) : ticks.map(() => ''),
      ...(withTime ? {} : { ticks: { show: false } }),
    },
    { ...common, size: kAxis_px, space: 26, values: (_plot, ticks, _axis, _space, step) => tickLabels(ticks, step) },
  ];
}

/** Greatest first, then least, and the band between the two, for every trace. */
function traces(panel: Panel): { series: uPlot.Series[]; bands: uPlot.Band[] } {
  const series: uPlot.Series[] = [{}];
  const bands: uPlot.Band[] = [];
  for (const trace of panel.traces) {
    const line = {
      stroke: () => resolved(trace.colour),
      width: trace.width ?? 1,
      points: { show: false },
      spanGaps: false,
    };
    series.push({ ...line, label: trace.label }, { ...line, label: `${trace.label} minimum` });
    const top = series.length - 2;
    bands.push({ series: [top, top + 1], fill: () => faded(resolved(trace.colour)) });
  }
  return { series, bands };
}

const faded = (colour: string) => colour.replace(/^rgb\(([^)]+)\)$/, 'rgba($1, 0.35)');

export function plotOptions(
  panel: Panel,
  width: number,
  withTime: boolean,
  named: boolean,
  syncKey: string,
  on: PlotEvents,
): uPlot.Options {
  return {
    width,
    height: panel.height_px + (withTime ? kTimeAxis_px : 0),
    padding: [8, 10, withTime ? 0 : 6, 0],
    legend: { show: false },
    ...traces(panel),
    axes: axes(withTime),
    scales: {
      x: { time: false, auto: false },
      y: {
        range: (_plot, least, greatest) => {
          if (least === null || greatest === null) return [0, 1];
          return uPlot.rangeNum(panel.fromZero ? Math.min(0, least) : least, greatest, 0.08, true);
        },
      },
    },
    cursor: {
      sync: { key: syncKey, scales: ['x', null] },
      drag: { x: true, y: false, setScale: false, dist: 4 },
      points: { show: false },
      y: false,
      bind: {
        dblclick: () => () => {
          on.onReset();
          return null;
        },
      },
    },
    hooks: {
      drawClear: [(plot) => drawSpans(plot, on.spans())],
      draw: [
        (plot) => {
          drawLevels(plot, panel);
          drawMarks(plot, on.marks(), named);
        },
      ],
      setCursor: [
        (plot) => {
          const left = plot.cursor.left ?? -1;
          on.onCursor(left < 0 ? null : plot.posToVal(left, 'x'));
        },
      ],
      setSelect: [
        (plot) => {
          const { left, width: selected } = plot.select;
          if (selected < 4) return;
          on.onRange({ from: plot.posToVal(left, 'x'), to: plot.posToVal(left + selected, 'x') });
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
    },
  };
}

/** Columns as uPlot takes them, in the display unit: time, then greatest and least of each trace. */
export function plotData(
  panel: Panel,
  t: readonly number[],
  channels: Readonly<Record<string, { min: readonly (number | null)[]; max: readonly (number | null)[] }>>,
): uPlot.AlignedData {
  const scale = panel.quantity.perSi;
  const shown = (values: readonly (number | null)[] | undefined) =>
    t.map((_, i) => {
      const value = values?.[i];
      return value === null || value === undefined ? null : value * scale;
    });
  return [
    [...t],
    ...panel.traces.flatMap(({ channel }) => [shown(channels[channel]?.max), shown(channels[channel]?.min)]),
  ];
}
