/** Numbers of the wire, each with its unit in the type from here on. */
import * as v from 'valibot';
import { metre, newton, second, utcMicroseconds } from '@/units';

export const finite = v.pipe(v.number(), v.finite());
export const count = v.pipe(finite, v.integer(), v.minValue(0));
export const inSeconds = v.pipe(finite, v.transform(second));
export const inMetres = v.pipe(finite, v.transform(metre));
export const inNewtons = v.pipe(finite, v.transform(newton));
export const inUtc = v.pipe(finite, v.transform(utcMicroseconds));
