import { describe, expect, it } from 'vitest';
import { formatFigure, formatFound, formatWithin, nameAndUnit } from '@/units';

const plain = (text: string) => text.replaceAll('\u202f', ' ');

describe('a figure', () => {
  it.each([
    [2.3301989, 'N', '2.33 N'],
    [0.061617, 'N', '0.0616 N'],
    [5150.69, 'N/m', '5151 N/m'],
    [0.0087, 'm', '8.70 mm'],
    [0.2618, 'rad', '15.0°'],
    [0.98647, '1', '0.986'],
    [0, 'N', '0 N'],
  ])('of %d %s has three digits that mean something: %s', (value, unit, text) => {
    expect(plain(formatFigure(value, unit))).toBe(text);
  });

  it('that does not exist is a dash', () => {
    expect(formatFigure(null, 'N')).toBe('–');
    expect(formatFigure(Number.NaN)).toBe('–');
  });
});

describe('a figure of a self-test', () => {
  it.each([
    [1.41e-6, 's', '1.41 µs'],
    [0.00025, 's', '250 µs'],
    [0.0708, 's', '70.8 ms'],
    [1, 's', '1.00 s'],
    [64_261_746_688, 'B', '64.3 GB'],
    [0.00286, 'm', '2.86 mm'],
    [0.0297, '', '2.97 %'],
    [0.001, '', '0.100 %'],
  ])('%d %s is read as %s', (value, unit, text) => {
    expect(plain(formatFound(value, unit))).toBe(text);
  });

  it('without a value is a dash', () => {
    expect(formatFound(null, 's')).toBe('–');
  });
});

describe('a fitted number', () => {
  it('has the digits that its uncertainty leaves', () => {
    expect(plain(formatWithin(2.3812921, 0.0010738, 'N'))).toBe('2.3813 ± 0.0011 N');
    expect(plain(formatWithin(5150.4514, 0.307, 'N/m'))).toBe('5150.45 ± 0.31 N/m');
    expect(plain(formatWithin(2.38, null, 'N'))).toBe('2.38 N');
  });
});

it.each([
  ['friction_N', 'friction', 'N'],
  ['damping_Ns_per_m', 'damping', 'N·s/m'],
  ['stribeck_velocity_m_s', 'stribeck velocity', 'm/s'],
  ['coefficient', 'coefficient', ''],
])('the name %s is taken apart', (name, words, unit) => {
  expect(nameAndUnit(name)).toEqual({ name: words, unit });
});
