import type { AnalysisFigure, MetricFacts } from '@/api';
import { curve, Plane, type Places } from '@/charts';
import { say } from '@/language';
import { formatCount } from '@/units';
import styles from './analysis.module.css';
import { axisName } from './columns';
import { groupTicks, spanOf, type Points, type Span } from './figure-axes';

type Panel = AnalysisFigure['panels'][number];

const pairs = (x: Points, y: Points) => x.map((value, i) => [value ?? Number.NaN, y[i] ?? Number.NaN] as const);

function Drawing({ panel, places, across }: { readonly panel: Panel; readonly places: Places; readonly across: Span }) {
  const dots = panel.lines.filter(({ points }) => points),
    curves = panel.lines.filter(({ points }) => !points);
  return (
    <>
      {panel.ribbons.map(({ label, x, low, high }) => (
        <path
          key={label}
          className={styles.band}
          d={`${curve([...pairs(x, high), ...pairs(x, low).reverse()], places)}Z`}
        />
      ))}
      {panel.marks.map(({ at, label }) => (
        <g key={`${at} ${label}`} className={styles.mark}>
          <line x1={places.x(across.from)} x2={places.x(across.to)} y1={places.y(at)} y2={places.y(at)} />
          <text x={places.x(across.from) + 4} y={places.y(at) - 4}>
            {label}
          </text>
        </g>
      ))}
      {dots.map(({ x, y }, i) => (
        <g key={i} className={styles.point}>
          {pairs(x, y).map(([at, height], k) =>
            Number.isFinite(at) && Number.isFinite(height) ? (
              <circle key={k} cx={places.x(at)} cy={places.y(height)} r={2.5} />
            ) : null,
          )}
        </g>
      ))}
      {curves.map(({ x, y }, i) => (
        <path key={i} className={styles.series} data-series={i % 3} d={curve(pairs(x, y), places)} />
      ))}
    </>
  );
}

function PanelView({ panel, metrics }: { readonly panel: Panel; readonly metrics: readonly MetricFacts[] }) {
  const { lines, ribbons, marks, group_names: groups } = panel;
  const grouped = groups.length > 0;
  const across = grouped
      ? { from: 0.5, to: groups.length + 0.5 }
      : spanOf(
          [...lines, ...ribbons].map(({ x }) => x),
          0.03,
        ),
    up = spanOf(
      [...lines.map(({ y }) => y), ...ribbons.flatMap(({ low, high }) => [low, high]), marks.map(({ at }) => at)],
      0.06,
    );
  const x = axisName(panel.x_label, metrics),
    y = axisName(panel.y_label, metrics);
  const drawn = lines.filter(({ points }) => !points);
  const title = panel.title === '' ? say('{y} by {x}', { y, x }) : panel.title;
  return (
    <div className={styles.panel}>
      <h3>{title}</h3>
      <Plane
        across={{ title: x, ...across, ...(grouped ? { ticks: groupTicks(groups) } : {}) }}
        up={{ title: y, ...up }}
        height_px={280}
        summary={say('{title}: {count} points{curves}.', {
          title,
          count: formatCount(lines.reduce((n, line) => n + (line.points ? line.x.length : 0), 0)),
          curves: [...drawn, ...ribbons].map(({ label }) => (label === '' ? '' : `, ${label}`)).join(''),
        })}
        data={{
          name: title,
          columns: ['series', 'x', 'y', 'low', 'high'],
          rows: [
            ...lines.flatMap((line) =>
              line.x.map((value, i) => [line.label || say('points'), value, line.y[i] ?? null, null, null]),
            ),
            ...ribbons.flatMap((band) =>
              band.x.map((value, i) => [band.label, value, null, band.low[i] ?? null, band.high[i] ?? null]),
            ),
          ],
        }}
      >
        {(places) => <Drawing panel={panel} places={places} across={across} />}
      </Plane>
      <ul className={styles.key}>
        {drawn.map(({ label }, i) =>
          label === '' ? null : (
            <li key={label}>
              <i data-series={i % 3} />
              {label}
            </li>
          ),
        )}
        {ribbons.map(({ label }) => (
          <li key={label}>
            <i data-series="band" />
            {label}
          </li>
        ))}
      </ul>
    </div>
  );
}

/** The figures of one analysis, panel by panel. */
export function FigureView({
  figures,
  metrics,
}: {
  readonly figures: readonly AnalysisFigure[];
  readonly metrics: readonly MetricFacts[];
}) {
  return (
    <div className={styles.figures} data-part="figures">
      {figures.flatMap(({ panels, note }, i) =>
        panels.map((panel, k) => (
          <div key={`${i} ${k}`} className={styles.stack}>
            <PanelView panel={panel} metrics={metrics} />
            {note === '' ? null : <p className={styles.muted}>{note}</p>}
          </div>
        )),
      )}
    </div>
  );
}
