import type { Distribution, LabChannel } from '@/api';
import { curve, Plane, stairs, type Places } from '@/charts';
import { say } from '@/language';
import { axisTitle, formatFigure } from '@/units';
import styles from './distributions.module.css';
import type { Names } from './overlay';
import { channelName, channelQuantity, channelUnit, joined } from './names';

interface Props {
  readonly before: LabChannel;
  readonly after: LabChannel | null;
  readonly names: Names;
}

const numbers = (values: readonly (number | null)[]) => values.map((value) => value ?? Number.NaN);
const most = (...rows: readonly (readonly (number | null)[])[]) =>
  rows.flat().reduce<number>((top, value) => Math.max(top, value ?? 0), 1e-9);

function extent(rows: readonly (readonly (number | null)[] | undefined)[]): [number, number] {
  const all = rows.flatMap((row) => row ?? []).filter((value): value is number => value !== null);
  return all.length === 0 ? [0, 1] : [Math.min(...all), Math.max(...all)];
}

/** The middle of a distribution: far tails would leave nothing to see. */
function middle(of: readonly (Distribution | undefined)[]): [number, number] {
  const known = of.filter((one) => one !== undefined);
  const low = Math.min(...known.map((one) => (one.p05 ?? 0) - 1.5 * (one.sd ?? 0))),
    high = Math.max(...known.map((one) => (one.p95 ?? 0) + 1.5 * (one.sd ?? 0)));
  const [least, greatest] = extent(known.map((one) => one.edges));
  const from = Math.max(low, least),
    to = Math.min(high, greatest);
  return to > from ? [from, to] : [least, greatest];
}

function Bars({
  of,
  within,
  places,
  series,
}: {
  readonly of: Distribution;
  readonly within: readonly [number, number];
  readonly places: Places;
  readonly series: 'measured' | 'before' | 'after';
}) {
  return (
    <path
      d={stairs(numbers(of.edges), numbers(of.shares), within, places)}
      className={styles.area}
      data-series={series}
    />
  );
}

const modelsOf = ({ before, after }: Names) => joined(after === null ? [before] : [before, after]);

const kBinColumns = ['signal', 'from', 'to', 'share'];

/** A histogram as rows of a file. */
const binRows = (name: string, of: Distribution | undefined): (string | number | null)[][] =>
  of ? of.shares.map((share, i) => [name, of.edges[i] ?? null, of.edges[i + 1] ?? null, share]) : [];

const residualText = (model: string, of: Distribution, unit: string) =>
  say('Residual of {model}: mean {mean}, standard deviation {sd}.', {
    model,
    mean: formatFigure(of.mean, unit),
    sd: formatFigure(of.sd, unit),
  });

function Residuals({ before, after, names }: Props) {
  if (!before.residual) return null;
  const quantity = channelQuantity(before.name),
    unit = channelUnit(before.name);
  const [from, to] = middle([before.residual, after?.residual]);
  const floor = before.noise_floor ?? Number.NaN;
  const summary = [
    residualText(names.before, before.residual, unit),
    ...(after?.residual ? [residualText(names.after ?? '', after.residual, unit)] : []),
    say('Noise floor: {floor}.', { floor: formatFigure(floor, unit) }),
  ].join(' ');
  return (
    <div>
      <h3>{say('Residual')}</h3>
      <Plane
        across={{ title: axisTitle(say('measured − simulated'), quantity), from, to }}
        up={{
          title: say('share of samples'),
          from: 0,
          to: most(before.residual.shares, after?.residual?.shares ?? []) * 1.05,
        }}
        summary={summary}
        data={{
          name: say('residual of {channel}', { channel: channelName(before.name) }),
          columns: kBinColumns,
          rows: [...binRows(names.before, before.residual), ...binRows(names.after ?? '', after?.residual)],
        }}
      >
        {(places) => (
          <>
            {[-floor, floor].map((at) => (
              <line key={at} x1={places.x(at)} x2={places.x(at)} y1={places.y(0)} y2={22} className={styles.floor} />
            ))}
            {before.residual ? <Bars within={[from, to]} of={before.residual} places={places} series="before" /> : null}
            {after?.residual ? <Bars within={[from, to]} of={after.residual} places={places} series="after" /> : null}
          </>
        )}
      </Plane>
    </div>
  );
}

function Values({ before, after, names }: Props) {
  if (!before.measured || !before.simulated) return null;
  const [from, to] = middle([before.measured, before.simulated, after?.simulated]);
  return (
    <div>
      <h3>{say('Values')}</h3>
      <Plane
        across={{ title: axisTitle(channelName(before.name), channelQuantity(before.name)), from, to }}
        up={{
          title: say('share of samples'),
          from: 0,
          to: most(before.measured.shares, before.simulated.shares, after?.simulated?.shares ?? []) * 1.05,
        }}
        summary={say('How often each value was measured, and simulated by {models}.', { models: modelsOf(names) })}
        data={{
          name: say('values of {channel}', { channel: channelName(before.name) }),
          columns: kBinColumns,
          rows: [
            ...binRows(say('measured'), before.measured),
            ...binRows(names.before, before.simulated),
            ...binRows(names.after ?? '', after?.simulated),
          ],
        }}
      >
        {(places) => (
          <>
            {before.measured ? (
              <Bars within={[from, to]} of={before.measured} places={places} series="measured" />
            ) : null}
            {before.simulated ? (
              <Bars within={[from, to]} of={before.simulated} places={places} series="before" />
            ) : null}
            {after?.simulated ? <Bars within={[from, to]} of={after.simulated} places={places} series="after" /> : null}
          </>
        )}
      </Plane>
    </div>
  );
}

function Spectra({ before, after, names }: Props) {
  const found = before.spectrum;
  if (!found || found.frequency_Hz.length < 2) return null;
  const frequency = numbers(found.frequency_Hz);
  const powers = [found.measured, found.residual, after?.spectrum?.residual ?? []]
    .flat()
    .filter((value): value is number => value !== null && value > 0);
  const low = Math.max(Math.min(...powers), Math.max(...powers) * 1e-9);
  const line = (values: readonly (number | null)[] | undefined, places: Places) =>
    curve(
      (values ?? []).map(
        (value, i) => [frequency[i] ?? Number.NaN, value === null || value <= 0 ? Number.NaN : value] as const,
      ),
      places,
    );
  return (
    <div>
      <h3>{say('Spectrum')}</h3>
      <Plane
        across={{ title: say('frequency, Hz'), from: frequency[0] ?? 1, to: frequency.at(-1) ?? 10, log: true }}
        up={{
          title: say('({unit})² per Hz', { unit: channelUnit(before.name) }),
          from: low,
          to: Math.max(...powers) * 2,
          log: true,
        }}
        summary={say('Power spectrum of the measured signal and of the residual of {models}.', {
          models: modelsOf(names),
        })}
        data={{
          name: say('spectrum of {channel}', { channel: channelName(before.name) }),
          columns: ['frequency_Hz', 'measured', names.before, ...(names.after === null ? [] : [names.after])],
          rows: found.frequency_Hz.map((at, i) => [
            at,
            found.measured[i] ?? null,
            found.residual[i] ?? null,
            ...(names.after === null ? [] : [after?.spectrum?.residual[i] ?? null]),
          ]),
        }}
      >
        {(places) => (
          <>
            <path d={line(found.measured, places)} className={styles.line} data-series="measured" />
            <path d={line(found.residual, places)} className={styles.line} data-series="before" />
            {after?.spectrum ? (
              <path d={line(after.spectrum.residual, places)} className={styles.line} data-series="after" />
            ) : null}
          </>
        )}
      </Plane>
    </div>
  );
}

/** Distribution of the residual, of the values, and their spectra, for one channel. */
export function Distributions(props: Props) {
  const { names } = props;
  return (
    <>
      <div className={styles.three}>
        <Residuals {...props} />
        <Values {...props} />
        <Spectra {...props} />
      </div>
      <ul className={styles.key}>
        <li>
          <i data-series="measured" />
          {say('measured')}
        </li>
        <li>
          <i data-series="before" />
          {names.before}
        </li>
        {names.after === null ? null : (
          <li>
            <i data-series="after" />
            {names.after}
          </li>
        )}
        <li>
          <i data-series="floor" />
          {say('± noise floor')}
        </li>
      </ul>
    </>
  );
}
