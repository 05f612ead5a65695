import { describe, expect, it } from 'vitest';
import {
  caseOf,
  draw,
  fiveOf,
  fromAddress,
  kMostMarks,
  kNoPlan,
  requestOf,
  toAddress,
  type Drawing,
  type EnvelopeMark,
  type Plan,
} from './plan';

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
      marks: [
        { at_m: [0.046, 0.2001, -0.061], radius_m: 0.003, bone: true },
        { at_m: [0.0465, 0.21, -0.0005], radius_m: 0.0015, bone: false },
      ],
    } satisfies Plan;
    expect(toAddress(plan)).toContain('marks=46,200.1,-61,3,+;46.5,210,-0.5,1.5,-');
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
  it('keeps an address of the most marks that there may be short enough for a server', () => {
    const marks = Array.from({ length: kMostMarks }, (_, i) => ({ ...kMark, at_m: [-0.12345, 0.2 + i * 1e-5, -0.5] }));
    // The server takes heads of 16 KiB; a request names the address twice, as what it asks for and where it comes from.
    expect(toAddress({ ...kNoPlan, marks: marks as EnvelopeMark[] }).length).toBeLessThan(6000);
  });
  it('takes from an address only the marks that are some', () => {
    const marks = (text: string) => fromAddress(`marks=${text}`).marks;
    expect(marks('1,2,3,3,%2B;1,2,3,3,+;4,5,6,2,-').map(({ bone }) => bone)).toEqual([true, true, false]);
    for (const bad of [
      '1,2,3,3',
      '1,2,,3,+',
      '1,2,3,0.9,+',
      '1,2,3,11,+',
      '1,2,3,x,+',
      '1,2,3,3,*',
      '1,2,3,3,+,4',
      ';',
    ])
      expect(marks(bad)).toEqual([]);
    expect(marks(Array.from({ length: 250 }, () => '1,2,3,3,+').join(';'))).toHaveLength(kMostMarks);
  });
});

const kMark: EnvelopeMark = { at_m: [0.046, 0.2001, -0.061], radius_m: 0.003, bone: false };

describe('marks of the envelope', () => {
  const paint = (drawing: Drawing, passing: boolean, mark = kMark) => draw(drawing, { kind: 'paint', mark, passing });

  it('go with the stroke that painted them, when it is undone', () => {
    const once = paint(empty, false, { ...kMark, bone: true });
    const stroke = paint(paint(paint(once, false), true), true);
    expect(stroke.plan.marks).toHaveLength(4);
    const back = draw(stroke, { kind: 'undo' });
    expect(back.plan.marks).toEqual([{ ...kMark, bone: true }]);
    expect(draw(back, { kind: 'redo' }).plan.marks).toHaveLength(4);
    expect(draw(back, { kind: 'undo' }).plan).toEqual(kNoPlan);
  });
  it('come back after all were removed', () => {
    const removed = draw(paint(empty, false), { kind: 'change', to: { marks: [] } });
    expect(removed.plan.marks).toEqual([]);
    expect(draw(removed, { kind: 'undo' }).plan.marks).toEqual([kMark]);
  });
  it('go one by one where they are erased, and come back with the stroke', () => {
    const far: EnvelopeMark = { ...kMark, at_m: [0.0561, 0.2001, -0.061] };
    const both = paint(paint(empty, false), false, far);
    const erase = (drawing: Drawing, x_m: number, passing: boolean) =>
      draw(drawing, { kind: 'erase', at_m: [x_m, 0.2001, -0.061], radius_m: 0.002, passing });
    const between = erase(both, 0.05105, false); // 5.05 mm from each: 3 + 2 mm do not touch
    expect(between.plan.marks).toEqual([kMark, far]);
    const one = erase(both, 0.0509, false);
    expect(one.plan.marks).toEqual([far]);
    const stroke = erase(one, 0.055, true);
    expect(stroke.plan.marks).toEqual([]);
    expect(draw(stroke, { kind: 'undo' }).plan.marks).toEqual([kMark, far]);
  });
  it('are no more than the server takes', () => {
    let drawing = empty;
    for (let i = 0; i <= kMostMarks; ++i) drawing = paint(drawing, i > 0);
    expect(drawing.plan.marks).toHaveLength(kMostMarks);
    expect(paint(drawing, false)).toBe(drawing);
  });
  it('are asked of the server to 1 µm, for filled bone alone, and for each case that is made', () => {
    const placed: Plan = {
      ...kNoPlan,
      entry: [0, 0, 0],
      target: [0, -0.04, 0],
      marks: [{ at_m: [0.01234567, 0, -0.0000004], radius_m: 0.0030000001, bone: true }],
    };
    const request = requestOf(placed);
    const tidy = [{ at_m: [0.012346, 0, -0], radius_m: 0.003, bone: true }];
    expect(request?.envelope_marks).toEqual(tidy);
    expect(requestOf({ ...placed, preparation: 'published' })).not.toHaveProperty('envelope_marks');
    expect(requestOf({ ...placed, marks: [] })).not.toHaveProperty('envelope_marks');
    if (!request) return;
    expect(caseOf(request, 'v', 'L3').envelope_marks).toEqual(tidy);
    expect(fiveOf(request, 'v', 'L3').map(({ envelope_marks }) => envelope_marks)).toEqual(Array(5).fill(tidy));
  });
});
