import { say } from '@/language';
import { formatMeasure } from '@/units';
import styles from './recording.module.css';

const kWidth = 240,
  kHeight = 48;

/** Lowest and highest value of each of at most `kWidth` parts, so that no peak is lost. */
function outline(values: Float64Array, low: number, high: number): string {
  const parts = Math.min(kWidth, values.length);
  const y = (value: number) => kHeight - 1 - ((kHeight - 2) * (value - low)) / (high - low || 1);
  return Array.from({ length: parts }, (_, i) => {
    const part = values.subarray(
      Math.floor((i * values.length) / parts),
      Math.floor(((i + 1) * values.length) / parts),
    );
    const x = parts > 1 ? (i * kWidth) / (parts - 1) : 0;
    const ends = [part.reduce((a, b) => Math.min(a, b), Infinity), part.reduce((a, b) => Math.max(a, b), -Infinity)];
    return ends.map((value) => `${Math.round(x)},${Math.round(10 * y(value)) / 10}`).join(' ');
  }).join(' ');
}

/** A column over time, small, with its range. */
export function ChannelPicture({ name, unit, values }: { name: string; unit: string; values: Float64Array }) {
  const low = values.reduce((a, b) => Math.min(a, b), Infinity),
    high = values.reduce((a, b) => Math.max(a, b), -Infinity);
  return (
    <figure className={styles.picture}>
      <svg viewBox={`0 0 ${kWidth} ${kHeight}`} preserveAspectRatio="none" aria-hidden="true">
        <polyline points={outline(values, low, high)} />
      </svg>
      <figcaption>
        {say('{column}: {low} to {high}', {
          column: name,
          low: formatMeasure(low, unit),
          high: formatMeasure(high, unit),
        })}
      </figcaption>
    </figure>
  );
}
