import { marked, say } from '@/language';
import { Notice, Scroll } from '@/ui';
import { formatCount, formatFigure, kNone } from '@/units';
import styles from './analysis.module.css';

const kHeadings: Record<string, string | undefined> = {
  name: marked('Term'),
  estimate: marked('Estimate'),
  standard_error: marked('Standard error'),
  t: 't',
  z: 'z',
  p: 'p',
  ci95_low: marked('95 % from'),
  ci95_high: marked('to'),
  hc3_standard_error: marked('SE, robust (HC3)'),
  statistic: marked('Statistic'),
  value: marked('Value'),
  df: 'df',
  df1: 'df',
  df2: marked('df residual'),
  effect: marked('Effect'),
  size: marked('Size'),
  term: marked('Term'),
  assumption: marked('Assumption'),
  found: marked('Found'),
  advice: marked('Advice'),
  level: marked('Level'),
  mean: marked('Mean'),
  sd: marked('SD'),
  n: 'n',
  hedges_g: 'Hedges’ g',
  hedges_g_ci95_low: marked('95 % from'),
  hedges_g_ci95_high: marked('to'),
  cohen_d: 'Cohen’s d',
  cohen_d_ci95_low: marked('95 % from'),
  cohen_d_ci95_high: marked('to'),
  glass_delta: 'Glass’ Δ',
  cliff_delta: 'Cliff’s δ',
};
const heading = (key: string) =>
  say(kHeadings[key] ?? (key.charAt(0).toUpperCase() + key.slice(1)).replaceAll('_', ' '));

export function cell(value: unknown, key = ''): string {
  if (value === null || value === undefined) return kNone;
  if (typeof value === 'number')
    return key === 'p' || key.endsWith('_p') || key === 'p_adjusted'
      ? value < 0.001
        ? 'p < 0.001'
        : formatFigure(value, '', 3)
      : Number.isInteger(value)
        ? formatCount(value)
        : formatFigure(value, '', 4);
  if (typeof value === 'boolean') return value ? say('yes') : say('no');
  if (typeof value === 'string') return value;
  return JSON.stringify(value);
}

type Line = Readonly<Record<string, unknown>>;
const isLine = (value: unknown): value is Line => typeof value === 'object' && value !== null && !Array.isArray(value);

function Lines({ caption, lines }: { readonly caption: string; readonly lines: readonly Line[] }) {
  const keys = [...new Set(lines.flatMap((line) => Object.keys(line)))].filter((key) =>
    lines.some((line) => !Array.isArray(line[key]) && !isLine(line[key])),
  );
  return (
    <Scroll label={caption}>
      <table className={styles.table}>
        <caption>{caption}</caption>
        <thead>
          <tr>
            {keys.map((key) => (
              <th
                key={key}
                scope="col"
                className={
                  lines.every((line) => typeof line[key] === 'number' || line[key] === null || line[key] === undefined)
                    ? styles.number
                    : undefined
                }
              >
                {heading(key)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {lines.map((line, i) => (
            <tr key={i}>
              {keys.map((key, k) => {
                const text = cell(line[key], key),
                  number = typeof line[key] === 'number';
                return k === 0 ? (
                  <th key={key} scope="row">
                    {text}
                  </th>
                ) : (
                  <td key={key} className={number ? styles.number : undefined}>
                    {text}
                  </td>
                );
              })}
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

const kShownElsewhere = new Set(['method', 'file', 'formula', 'rows', 'rows_left_out', 'tests', 'checks', 'notes']);

/** The report of one method: tables, figures, assumption checks and notes. */
export function ReportView({ report }: { readonly report: Line }) {
  const entries = Object.entries(report).filter(([key]) => !kShownElsewhere.has(key));
  const checks = Array.isArray(report.checks) ? report.checks.filter(isLine) : [];
  const notes = Array.isArray(report.notes)
    ? report.notes.filter((note): note is string => typeof note === 'string')
    : [];
  const loose = entries.filter(([, value]) => !Array.isArray(value) && !isLine(value));
  return (
    <div className={styles.stack}>
      {entries.map(([key, value]) => {
        if (Array.isArray(value))
          return value.length > 0 && value.every(isLine) ? (
            <Lines key={key} caption={heading(key)} lines={value} />
          ) : null;
        return isLine(value) ? <Lines key={key} caption={heading(key)} lines={[value]} /> : null;
      })}
      {loose.length > 0 ? (
        <p className={styles.muted}>
          {loose.map(([key, value]) => `${heading(key)}: ${cell(value, key)}`).join(' · ')}
        </p>
      ) : null}
      {checks.length > 0 ? <Lines caption={say('Assumption checks')} lines={checks} /> : null}
      {notes.map((note) => (
        <Notice key={note} tone="warn" title={say('Note')}>
          {note}
        </Notice>
      ))}
    </div>
  );
}
