import { describe, expect, it } from 'vitest';
import {
  decimalsFor,
  digits,
  formatAngle,
  formatCount,
  formatDuration,
  formatForce,
  formatLength,
  formatMeasure,
  formatRate,
  formatShare,
  formatTorque,
  kForce,
  kTorque,
  measureDigits,
  metre,
  newton,
  newtonMetre,
  radian,
  rounded,
  second,
  share,
  shownUnit,
  tickLabels,
  timeZone,
} from '@/units';

const plain = (text: string) => text.replaceAll('\u202f', ' ');

describe('a number of the trial', () => {
  it('is shown in the unit of the clinic, from SI', () => {
    expect(plain(formatForce(newton(7.78)))).toBe('7.78 N'); // Basel paper, Table 1, max of F_z
    expect(plain(formatTorque(newtonMetre(0.134)))).toBe('0.134 N·m'); // the same, max of T_xy
    expect(plain(formatLength(metre(0.009)))).toBe('9.0 mm');
    expect(plain(formatAngle(radian(Math.PI / 2)))).toBe('90.0°');
  });

  it('that is small but not zero never reads as zero', () => {
    expect(plain(digits(0.0004, kTorque))).toBe('< 0.001'); // how the paper prints the sd of T_z
    expect(plain(digits(-0.0004, kTorque))).toBe('> −0.001');
    expect(digits(0, kTorque)).toBe('0.000');
  });

  it('that moves under the pointer is rounded plainly, without a minus before zero', () => {
    expect(rounded(-0.0004, kTorque)).toBe('0.000');
    expect(rounded(-0.0016, kTorque)).toBe('−0.002');
  });

  it('that is missing or not finite is a dash', () => {
    expect(digits(Number.NaN, kForce)).toBe('–');
    expect(formatMeasure(null, 'N')).toBe('–');
    expect(formatDuration(second(Number.POSITIVE_INFINITY))).toBe('–');
  });

  it('keeps its sign as a minus, not a hyphen', () => {
    expect(plain(formatForce(newton(-1.5)))).toBe('−1.50 N');
  });
});

describe('a duration', () => {
  it.each([
    [42.46, '42.5 s'],
    [119.9, '119.9 s'],
    [185, '3 min 05 s'],
    [3720, '1 h 02 min'],
  ])('of %d s reads %s', (value, text) => {
    expect(plain(formatDuration(second(value)))).toBe(text);
  });
});

describe('the time zone', () => {
  it.each([
    [-120, /, UTC\+2$/],
    [-330, /, UTC\+5:30$/],
    [210, /, UTC−3:30$/],
  ])('of which local time is %d min ahead is named beside times', (getTimezoneOffset, text) => {
    expect(timeZone({ getTimezoneOffset: () => getTimezoneOffset } as unknown as Date)).toMatch(text);
  });
});

describe('a share', () => {
  it('is never rounded to none or to all', () => {
    expect(plain(formatShare(share(0.001)))).toBe('< 1 %');
    expect(plain(formatShare(share(0.999)))).toBe('> 99 %');
    expect(plain(formatShare(share(0)))).toBe('0 %');
    expect(plain(formatShare(share(1)))).toBe('100 %');
    expect(plain(formatShare(share(0.00005), 3))).toBe('0.005 %');
  });
});

describe('a measure of the server', () => {
  it('is converted from the unit that it names', () => {
    expect(plain(formatMeasure(0.412, 'm'))).toBe('412.0 mm');
    expect(plain(formatMeasure(0.037, 'N·m'))).toBe('0.037 N·m');
    expect(plain(formatMeasure(0.0123, 'm/s'))).toBe('12.3 mm/s');
    expect(measureDigits(0.28, 'N')).toBe('0.28');
    expect(shownUnit('m')).toBe('mm');
    expect(plain(formatMeasure(2.5e-5, 'm^2/s^2'))).toBe('25.0 mm²/s²'); // (5 mm/s)²
    expect(plain(formatMeasure(764.2, 'N^2'))).toBe('764.2 N²');
  });

  it('keeps a unit that is not known here', () => {
    expect(plain(formatMeasure(3.14159, 'rad/s'))).toBe('3.14 rad/s');
    expect(formatMeasure(0.625, '1')).toBe('0.625');
    expect(formatMeasure(3, '1')).toBe('3');
  });
});

describe('counts and rates', () => {
  it('are grouped from five digits on', () => {
    expect(plain(formatCount(240000))).toBe('240 000');
    expect(formatCount(4000)).toBe('4000');
    expect(plain(formatRate(4000))).toBe('4 kHz');
    expect(plain(formatRate(100))).toBe('100 Hz');
  });
});

describe('the labels of an axis', () => {
  it('have as many decimals as the step needs', () => {
    expect(decimalsFor(0.05)).toBe(2);
    expect(decimalsFor(20)).toBe(0);
    expect(tickLabels([-0.05, 0, 0.05], 0.05)).toEqual(['−0.05', '0.00', '0.05']);
  });
});
