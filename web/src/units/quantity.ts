/** SI numbers with their unit in the type, so that a force is never passed for a torque. */
declare const unit: unique symbol;
type In<Name extends string> = number & { readonly [unit]: Name };

export type Newton = In<'N'>;
export type NewtonMetre = In<'N·m'>;
export type Metre = In<'m'>;
export type Second = In<'s'>;
export type Radian = In<'rad'>;
/** A share of a whole, 0 to 1. */
export type Share = In<'1'>;
/** Microseconds of UTC since 1970, as every time stamp on the wire. */
export type UtcMicroseconds = In<'utc_us'>;

export const newton = (si: number) => si as Newton;
export const newtonMetre = (si: number) => si as NewtonMetre;
export const metre = (si: number) => si as Metre;
export const second = (si: number) => si as Second;
export const radian = (si: number) => si as Radian;
export const share = (si: number) => si as Share;
export const utcMicroseconds = (us: number) => us as UtcMicroseconds;

/** How a kind of quantity is shown to a person: unit, factor from SI and the decimals worth reading. */
export interface Quantity {
  readonly name: string;
  readonly unit: string;
  readonly perSi: number;
  readonly decimals: number;
}

export const kForce: Quantity = { name: 'Force', unit: 'N', perSi: 1, decimals: 2 };
export const kTorque: Quantity = { name: 'Torque', unit: 'N·m', perSi: 1, decimals: 3 };
export const kLength: Quantity = { name: 'Length', unit: 'mm', perSi: 1000, decimals: 1 };
export const kAngle: Quantity = { name: 'Angle', unit: '°', perSi: 180 / Math.PI, decimals: 1 };
export const kSpeed: Quantity = { name: 'Speed', unit: 'mm/s', perSi: 1000, decimals: 1 };
export const kTime: Quantity = { name: 'Time', unit: 's', perSi: 1, decimals: 2 };
