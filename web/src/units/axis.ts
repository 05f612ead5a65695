/** Ticks of an axis: as many decimals as the step needs, all ticks alike. */
import type { Quantity } from './quantity';
import { decimalMark } from './written';

/** Decimals that tell two neighbouring ticks apart. */
export function decimalsFor(step: number): number {
  if (!(step > 0) || !Number.isFinite(step)) return 0;
  for (let decimals = 0; decimals < 9; ++decimals) {
    const scaled = step * 10 ** decimals;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return decimals;
  }
  return 9;
}

/** Labels of ticks that are in the display unit already. */
export function tickLabels(ticks: readonly number[], step: number): string[] {
  const decimals = decimalsFor(step);
  return ticks.map((tick) => {
    const text = Math.abs(tick).toFixed(decimals);
    const shown = text.replace('.', decimalMark());
    return tick < 0 && Number(text) !== 0 ? `−${shown}` : shown;
  });
}

/** "Force, N" */
export const axisTitle = (name: string, quantity: Quantity) => `${name}, ${quantity.unit}`;
