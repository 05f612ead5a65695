import { describe, expect, it } from 'vitest';
import { draw, fiveOf, fromAddress, kNoPlan, toAddress, requestOf, type Drawing } from './plan';

const empty: Drawing = { plan: kNoPlan, past: [], future: [] };

describe('a plan of a case', () => {
  it('brings back what a drag began with, not each of its moves', () => {
    const placed = draw(empty, { kind: 'change', to: { entry: [0.04, 0.2, -0.06] } });
    // A drag: its first move is a step, the others pass.
    const begun = draw(placed, { kind: 'change', to: { entry: [0.041, 0.2, -0.06] } });
    const moved = draw(begun, { kind: 'change', to: { entry: [0.05, 0.2, -0.06] }, passing: true });
    const back = draw(moved, { kind: 'undo' });
    expect(back.plan.entry).toEqual([0.04, 0.2, -0.06]);
    expect(draw(back, { kind: 'redo' }).plan.entry).toEqual([0.05, 0.2, -0.06]);
  });
  it('asks nothing of the server until both ends are placed', () => {
    expect(requestOf({ ...kNoPlan, entry: [0, 0, 0] })).toBeNull();
    expect(requestOf({ ...kNoPlan, entry: [0, 0, 0], target: [0, -0.04, 0] })).toMatchObject({
      target_m: [0, -0.04, 0],
      breach: null,
    });
  });
  it('asks nothing of the server for a breach deeper than is allowed, instead of keeping an older depth', () => {
    const placed = { ...kNoPlan, entry: [0, 0, 0], target: [0, -0.04, 0] } as const;
    const request = (depth_m: number) =>
      requestOf({ ...placed, breach: { wall: 'medial', depth_m, at_m: null } })?.breach?.depth_m;
    expect(request(0.015)).toBe(0.015);
    expect(request(0.099)).toBeUndefined();
    expect(request(0)).toBeUndefined();
  });
  it('is the same after it was an address', () => {
    const plan = {
      entry: [0.0453, 0.1991, -0.0611],
      target: [0.039, 0.158, -0.061],
      radius_m: 0.0015,
      breach: { wall: 'medial', depth_m: 0.003, at_m: null },
      whole: false,
      preparation: 'published',
    } as const;
    expect(fromAddress(toAddress(plan))).toEqual(plan);
  });
  it('asks for no breach in bone that is left whole, and says so in its address', () => {
    const plan = {
      ...kNoPlan,
      entry: [0, 0, 0],
      target: [0, -0.04, 0],
      breach: { wall: 'medial', depth_m: 0.003, at_m: null },
      whole: true,
    } as const;
    expect(requestOf(plan)).toMatchObject({ channel: 'planned', breach: null });
    expect(fromAddress(toAddress(plan)).whole).toBe(true);
  });
  it('asks for a breach of each wall, all as hard to tell, for a set of five', () => {
    const request = requestOf({ ...kNoPlan, entry: [0, 0, 0], target: [0, -0.04, 0] });
    const five = request ? fiveOf(request, 'v', 'L3') : [];
    expect(five.map(({ breach }) => breach?.wall)).toEqual(['medial', 'lateral', 'superior', 'inferior', 'anterior']);
    expect(five.every(({ breach, preparation }) => breach?.even === true && preparation === 'filled')).toBe(true);
    expect(five[0]?.title).toBe('L3, medial breach');
  });
  it('takes nothing from an address that is none', () => {
    expect(fromAddress('entry=1,2&target=a,b,c&breach=upwards,3')).toEqual(kNoPlan);
  });
});
