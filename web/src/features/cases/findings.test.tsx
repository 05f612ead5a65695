import { render, screen } from '@testing-library/react';
import { describe, expect, it } from 'vitest';
import type { PlannedTract } from '@/api';
import { metre } from '@/units';
import { Findings, Peaks } from './findings';
import { kNoPlan, type Plan } from './plan';

const kPlan: Plan = { ...kNoPlan, entry: [0, 0, 0], target: [0, -0.04, 0] };
const kEnvelope = { around: 3, points_m: [] };
const kRefused: PlannedTract = {
  length_m: metre(0.04),
  side: null,
  tract: null,
  walls: [],
  breach: null,
  problems: ['the bone goes on into a rib'],
  warnings: [],
  envelope: kEnvelope,
  calibration: null,
};
const advice = (plan: Plan, found: PlannedTract) =>
  render(<Findings plan={plan} found={found} looking={false} />).container.querySelector('[data-part="advice"]');

describe('what to do about a problem', () => {
  it('is said where there is an envelope that can be corrected', () => {
    expect(advice(kPlan, kRefused)?.textContent).toContain('paint where bone is or is not');
  });
  it('is not said without a problem, without an envelope, or for published bone', () => {
    expect(advice(kPlan, { ...kRefused, problems: [] })).toBeNull();
    expect(advice(kPlan, { ...kRefused, envelope: null })).toBeNull();
    expect(advice({ ...kPlan, preparation: 'published' }, kRefused)).toBeNull();
  });
});

it('names the peaks of the CT values in whole HU, also those that were not found, and the cortex in hundredths of a millimetre', () => {
  const calibration = {
    air_HU: -1002.6,
    fat_HU: null,
    soft_tissue_HU: 42,
    cancellous_HU: 0.3,
    cortical_HU: 620,
    cortex_m: metre(0.00057),
  };
  render(<Peaks calibration={calibration} />);
  expect(screen.getByText(/Peaks/).textContent.replaceAll('\u202f', ' ')).toBe(
    'Peaks of the CT values: air −1003 HU, fat not found, soft tissue 42 HU, cancellous bone 0 HU, cortical bone 620 HU; thickness of the cortex 0.57 mm.',
  );
});
