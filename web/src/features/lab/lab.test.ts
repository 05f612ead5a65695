import { File as NodeFile } from 'node:buffer';
import { describe, expect, it } from 'vitest';
import type { Diagnosis, LabRun } from '@/api';
import { differences } from './differences';
import { primaryUnit } from './comparison-parts';
import { kBlankOwn, mistypedStates, ownEffect, parametersIn, withFormula, withState } from './own-effect';
import { parameterName } from './parameters';
import { isNotBetter, verdictOf } from './verdict';
import { channelQuantity, effectName, joined } from './names';
import { pack, problemsOf, rootOf } from './zip-files';

const plain = (text: string) => text.replaceAll('\u202f', ' ');

describe('a folder that was dropped', () => {
  it('is entered where its set.json lies, the highest one', () => {
    expect(rootOf(['./rec/trial1.csv', './rec/set.json', './rec/old/set.json'])).toBe('rec/');
    expect(rootOf(['set.json', 'a.csv'])).toBe('');
    expect(rootOf(['/rec/reset.json'])).toBeNull();
  });

  it('gives the set its name; files without a folder take the one that set.json states', async () => {
    const file = (text: string, name: string) => new NodeFile([text], name) as unknown as File; // jsdom's has no arrayBuffer
    const dropped = (root: string, set = '{}') => [
      { path: `${root}set.json`, file: file(set, 'set.json') },
      { path: `${root}a.csv`, file: file('t_s', 'a.csv') },
    ];
    expect((await pack(dropped('./bench, 3 May/'))).name).toBe('bench, 3 May');
    expect((await pack(dropped('/rec/'))).name).toBe('rec');
    expect((await pack(dropped('', '{"name":"rig 2, dry"}'))).name).toBe('rig 2, dry');
    expect((await pack(dropped('', 'no JSON'))).name).toBe('Measurements');
  });

  it('is refused with its faults by file and line', () => {
    expect(
      problemsOf(
        'trial1.csv:17: column fz_N: "abc" is not a number\ntrial3.csv, line 4: t_s does not rise\nset.json: no trials',
      ),
    ).toEqual([
      { file: 'trial1.csv', line: 17, what: 'column fz_N: "abc" is not a number' },
      { file: 'trial3.csv', line: 4, what: 't_s does not rise' },
      { file: 'set.json', line: null, what: 'no trials' },
    ]);
    expect(problemsOf('The server does not answer.')).toEqual([
      { file: '', line: null, what: 'The server does not answer.' },
    ]);
  });
});

describe('a formula of one’s own', () => {
  const states = [{ name: 'v_m_s' }, { name: 'x_m' }];

  it('has as parameters what is neither a state nor a function', () => {
    expect(parametersIn('c * v_m_s * abs(v_m_s) + k*exp(-x_m/d) + 1e3', states)).toEqual(['c', 'k', 'd']);
  });

  it('keeps what was written of a parameter while the formula changes', () => {
    const first = withFormula(kBlankOwn, 'c * v_m_s', states);
    const second = withFormula(
      { ...first, parameters: first.parameters.map((one) => ({ ...one, unit: 'N*s/m' })) },
      'c * v_m_s + k',
      states,
    );
    expect(second.parameters.map(({ name, unit }) => [name, unit])).toEqual([
      ['c', 'N*s/m'],
      ['k', '1'],
    ]);
  });

  it('starts a divisor with a minimum above zero', () => {
    const { parameters } = withFormula(kBlankOwn, 'f * tanh(v_m_s / v0)', states);
    expect(parameters.map(({ name, low }) => [name, low])).toEqual([
      ['f', '0'],
      ['v0', '0.001'],
    ]);
  });

  it('points out a parameter that looks like a state variable', () => {
    expect(mistypedStates(withFormula(kBlankOwn, 'f * sign(v)', states), states)).toEqual([
      { typed: 'v', state: 'v_m_s' },
    ]);
    expect(mistypedStates(withFormula(kBlankOwn, 'f * sign(v_m_s)', states), states)).toEqual([]);
  });

  it('is not checked, and so not fitted, until a mistyped state variable is replaced', () => {
    const typed = withFormula(kBlankOwn, 'F_c*sign(v) + v_c', states);
    expect(ownEffect(typed, 'probing', { adds_to: 'fz_N', states })).toBeNull();
    const formula = withState(typed.formula, 'v', 'v_m_s');
    expect(formula).toBe('F_c*sign(v_m_s) + v_c');
    const clear = withFormula(typed, formula, states);
    expect(clear.parameters.map(({ name }) => name)).toEqual(['F_c', 'v_c']);
    expect(ownEffect(clear, 'probing', { adds_to: 'fz_N', states })).toMatchObject({ formula });
  });

  it('goes to the server as tractus-effect/1, and not before there is one', () => {
    expect(ownEffect(kBlankOwn, 'probing', { adds_to: 'fz_N', states })).toBeNull();
    const draft = {
      name: 'drag',
      formula: ' c * v_m_s ',
      parameters: [{ name: 'c', unit: 'N*s/m', initial: '2', low: '0', high: '50' }],
    };
    expect(ownEffect(draft, 'probing', { adds_to: 'fz_N', states })).toEqual({
      format: 'tractus-effect/1',
      id: 'expression:drag',
      rig: 'probing',
      adds_to: 'fz_N',
      formula: 'c * v_m_s',
      parameters: { c: { unit: 'N*s/m', initial: 2, low: 0, high: 50 } },
    });
  });
});

describe('two versions', () => {
  const old = { base: { layers: [{ stiffness_N_per_m: 4000, damping_Ns_per_m: 2000 }] }, effects: [] };

  it('differ in the numbers that changed and in those that came', () => {
    const now = {
      base: { layers: [{ stiffness_N_per_m: 4100, damping_Ns_per_m: 2000 }] },
      effects: [{ id: 'coulomb_friction', parameters: { friction_N: 2.3 } }],
    };
    expect(differences(old, now)).toEqual([
      { name: '/base/layers/0/stiffness_N_per_m', a: 4000, b: 4100 },
      { name: 'coulomb_friction/friction_N', a: null, b: 2.3 },
    ]);
    expect(differences(old, old)).toEqual([]);
  });

  it('have their numbers named for a person', () => {
    expect(parameterName('/base/layers/0/stiffness_N_per_m')).toEqual({ name: 'Layer 1, stiffness', unit: 'N/m' });
    expect(parameterName('/base/rotary/detent_Nm')).toEqual({ name: 'Rotary, detent', unit: 'N·m' });
    expect(parameterName('pose_offset/offset_m/2')).toEqual({ name: 'Pose offset, offset z', unit: 'm' });
  });
});

describe('the verdict', () => {
  const diagnosis = (changes: Partial<Diagnosis>): Diagnosis => ({
    verdict: 'missing',
    headline: '',
    detail: '',
    probability: 0.98,
    base: { rmse: 1.78, held_out_rmse: 1.99, noise_floor: 0.0616 },
    effects: [{ id: 'coulomb_friction', probability: 0.98, parameters: {} }],
    ranking: [],
    steps: [
      { model: 'base', rmse: 1.78, held_out_rmse: 1.99 },
      { model: '+ coulomb_friction', rmse: 0.0501, held_out_rmse: 0.0502 },
    ],
    confounded: [],
    settle: null,
    depends_on: '',
    held_out: 'trials',
    parameters: [],
    trials: [],
    notes: [],
    ...changes,
  });

  it('shows the sentences of the server and the probability', () => {
    const { tone, headline, detail } = verdictOf(
      diagnosis({ headline: 'Coulomb friction is missing.', detail: 'The error falls from 1.99 N to 0.05 N.' }),
    );
    expect(tone).toBe('accent');
    expect(headline).toBe('Coulomb friction is missing.');
    expect(plain(detail)).toMatch(/^The error falls from 1\.99 N to 0\.05 N\. Probability of this answer: /);
  });

  it('names the kind of verdict for a result without sentences', () => {
    expect(
      verdictOf(diagnosis({ verdict: 'undecided', effects: [], probability: null, detail: 'All noise.' })),
    ).toEqual({
      tone: 'warn',
      headline: 'These recordings cannot tell whether an effect is missing.',
      detail: 'All noise.',
    });
    expect(verdictOf(diagnosis({ verdict: 'complete', effects: [] }))).toMatchObject({
      tone: 'good',
      headline: 'No effect is missing.',
    });
  });
});

describe('the unit of the error', () => {
  it('is that of the primary channel, and newton until the comparison is known', () => {
    const compared = (primary: string) =>
      ({ comparisons: { before: { primary, channels: [{ name: primary }] }, after: null } }) as unknown as Pick<
        LabRun,
        'comparisons'
      >;
    expect(primaryUnit(compared('tz_Nm'))).toBe('N·m');
    expect(primaryUnit({ comparisons: null })).toBe('N');
  });
});

describe('names of the lab', () => {
  it('are made from ids', () => {
    expect(effectName('expression:drag')).toBe('drag (custom formula)');
    expect(joined(['a', 'b', 'c'])).toBe('a, b and c');
    expect(channelQuantity('tz_Nm').unit).toBe('N·m');
    expect(channelQuantity('fz_N').unit).toBe('N');
  });
});

describe('a model that is to be published', () => {
  const fit = (before: number | null, held_out_rmse: number | null) =>
    isNotBetter({ fit: { base: { rmse: before }, held_out_rmse }, diagnosis: null } as unknown as LabRun);
  const search = (before: number, after: number) =>
    isNotBetter({
      fit: null,
      diagnosis: { base: { held_out_rmse: before }, steps: [{ held_out_rmse: before }, { held_out_rmse: after }] },
    } as unknown as LabRun);

  it('is told apart from one that is no better than the old one', () => {
    expect(fit(1.54, 1.57)).toBe(true);
    expect(fit(1.54, 0.06)).toBe(false);
    expect(fit(1.54, null)).toBe(false);
    expect(search(1.83, 0.05)).toBe(false);
    expect(search(1.83, 1.83)).toBe(true);
  });
});
