import type { Quantity } from '@/units';

export interface Trace {
  /** Channel in the detail. */
  readonly channel: string;
  readonly label: string;
  /** The quantity's letter and its index, as printed: F, xy. */
  readonly symbol?: readonly [string, string];
  /** Colour token, "--series-across". */
  readonly colour: string;
}

/** One set of axes: traces of one quantity against time. */
export interface Panel {
  readonly id: string;
  readonly title: string;
  readonly quantity: Quantity;
  readonly traces: readonly Trace[];
  readonly height_px: number;
  /** Axis that always shows zero. */
  readonly fromZero?: boolean;
}

/** A moment marked in every panel. */
export interface Mark { readonly t_s: number; readonly label: string }
