import { describe, expect, it } from 'vitest';
import type { ScenarioFile } from '@/api';
import {
  draftOf,
  fromShown,
  inMillimetres,
  inUnitsOf,
  kBone,
  shown,
  valueAt,
  withLayer,
  withValue,
  withWall,
} from './draft';

const file: ScenarioFile = {
  format: 'tractus-scenario/1',
  name: 'hard',
  kind: 'hard',
  density: 1,
  travel_m: 0.05,
  walls_m: [],
  layers: [],
  bone: { stiffness_N_per_m: 8000, damping_Ns_per_m: 5000, equilibrium_m: -0.004, interval_m: 0.004 },
  breach: {
    resistance_interval_m: 0.006,
    resistance_factor_per_m: 105,
    breach_interval_m: 0.008,
    breach_damping_Ns_per_m: 1200,
  },
  rotary: { viscous_Nms_per_rad: 0.02, detent_Nm: 0.01, detent_pitch_rad: 0.35 },
  origin: { who: 'x', when: 'y' },
};

describe('a scenario being tuned', () => {
  it('keeps what a person types as SI, to the digit', () => {
    const knob = kBone[3] ?? { times: 1 };
    expect(shown(0.004, knob)).toBe('4');
    expect(fromShown('4.1', knob)).toBe(0.0041);
  });
  it('changes one number and leaves the rest', () => {
    const next = withValue(file, '/bone/stiffness_N_per_m', 9000);
    expect(next.bone).toEqual({ ...file.bone, stiffness_N_per_m: 9000 });
    expect(next.rotary).toBe(file.rotary);
    expect(valueAt(withValue(withLayer(file), '/layers/0/density', 2), '/layers/0/density')).toBe(2);
  });
  it('puts walls in order, where there is most room', () => {
    expect(withWall(file).walls_m).toEqual([0.025]);
    expect(withWall({ ...file, walls_m: [0.04] }).walls_m).toEqual([0.02, 0.04]);
  });
  it('does not lay a stretch beyond the probe stop', () => {
    expect(withLayer({ ...file, layers: [{ start_m: 0, thickness_m: 0.05, density: 1 }] }).layers).toHaveLength(1);
  });
  it('says what is out of range in the unit of the field', () => {
    expect(inUnitsOf('-1000 is outside 0 … 200000', { times: 1e-3, unit: 'N/mm' })).toBe('-1 is outside 0 … 200 N/mm');
    expect(
      inUnitsOf('0.032 plus the breach interval lies beyond the travel of 0.02 m', { times: 1e3, unit: 'mm' }),
    ).toBe('32 mm plus the breach interval lies beyond the travel of 20 mm');
    expect(
      inUnitsOf('0.02 leaves less than a layer of bone behind the breach, which ends at 0.018 m', {
        times: 1e3,
        unit: 'mm',
      }),
    ).toBe('20 mm leaves less than a layer of bone behind the breach, which ends at 18 mm');
    expect(inMillimetres('behind the wall at 0.012 m the stage would move at 0.249 m/s under 300 N')).toBe(
      'behind the wall at 12 mm the stage would move at 0.249 m/s under 300 N',
    );
    expect(inUnitsOf('is missing', { times: 1e-3, unit: 'N/mm' })).toBe('is missing');
  });
  it('leaves who and when to the server', () => {
    expect(draftOf(file)).not.toHaveProperty('origin');
  });
});
