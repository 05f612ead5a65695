import { describe, expect, it } from 'vitest';
import { byProgress, byTime, rowAt, type Way } from './align';

/** Advances 1 mm a second, or slower by a factor, then stays for a while. */
function steady(factor: number, deep_mm: number, rest_s: number): Way {
  const seconds = deep_mm * factor + rest_s;
  const t_s = Array.from({ length: seconds * 100 + 1 }, (_, i) => i / 100);
  const depth_m = t_s.map((t) => Math.min(t / factor, deep_mm) / 1000);
  return { t_s, depth_m, force_N: t_s.map(() => 0) };
}

describe('two trials beside each other', () => {
  it('go together where both are as deep', () => {
    const at = byProgress(steady(1, 20, 0), steady(3, 20, 0));
    for (const t of [0, 5, 10, 20]) expect(at(t)).toBeCloseTo(3 * t, 0);
  });
  it('end together, whatever each did at the end of the tract', () => {
    const at = byProgress(steady(1, 20, 4), steady(2, 20, 30));
    expect(at(24)).toBeCloseTo(70, 6);
    expect(at(22)).toBeCloseTo(55, 0);
  });
  it('never run back', () => {
    const wandering = steady(1, 20, 0);
    const withdrawn = {
      ...wandering,
      depth_m: wandering.depth_m.map((depth, i) => (i > 800 && i < 1200 ? 0.002 : depth)),
    };
    const at = byProgress(withdrawn, steady(2, 20, 5));
    let before = -1;
    for (let t = 0; t <= 20; t += 0.25) {
      expect(at(t)).toBeGreaterThanOrEqual(before);
      before = at(t);
    }
  });
  it('wait at the end when they go by the clock', () => {
    expect(byTime(steady(1, 5, 0))(3)).toBe(3);
    expect(byTime(steady(1, 5, 0))(9)).toBe(5);
  });
  it('stay within their samples', () => {
    expect([-1, 0, 0.9, 1, 7].map((t) => rowAt([0, 1, 2], t))).toEqual([0, 0, 0, 1, 2]);
  });
});
