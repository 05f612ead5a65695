import type { Quantity } from '@/units';

export interface Trace {
  /** Channel in the detail. */
  readonly channel: string;
  readonly label: string;
  /** The quantity's letter and its index, as printed: F, xy. */
  readonly symbol?: readonly [string, string];
  /** Colour token, "--series-across". */
  readonly colour: string;
  /** px of the line; 1 where nothing is said. */
  readonly width?: number;
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
  /** Lines across, in SI: a noise floor. */
  readonly levels?: readonly Level[];
}

export interface Level {
  readonly value: number;
  readonly label: string;
}

/** A moment marked in every panel. */
export interface Mark {
  readonly t_s: number;
  readonly label: string;
}

/** A stretch of time that is shaded in every panel. */
export interface Span {
  readonly from_s: number;
  readonly to_s: number;
}
