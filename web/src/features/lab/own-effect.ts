/** A formula of one's own as it is being written, and as the server takes it. Pure. */
import { nameAndUnit } from '@/units';
import type { EffectList, OwnEffect, Rig } from '@/api';

export interface OwnParameter {
  readonly name: string;
  readonly unit: string;
  readonly initial: string;
  readonly low: string;
  readonly high: string;
}
export interface OwnDraft {
  readonly name: string;
  readonly formula: string;
  readonly parameters: readonly OwnParameter[];
}

export const kBlankOwn: OwnDraft = { name: 'my_effect', formula: '', parameters: [] };

/** Words that the formula's grammar keeps for itself. */
const kFunctions = new Set([
  'abs',
  'sqrt',
  'sign',
  'min',
  'max',
  'exp',
  'ln',
  'sin',
  'cos',
  'tan',
  'asin',
  'acos',
  'atan',
  'sinh',
  'cosh',
  'tanh',
  'pi',
]);

/** Names in the formula that are neither states nor functions: its parameters. */
export function parametersIn(formula: string, states: readonly { readonly name: string }[]): string[] {
  const known = new Set(states.map(({ name }) => name));
  const names = formula.match(/[A-Za-z_][A-Za-z0-9_]*/g) ?? [];
  return [...new Set(names)].filter((name) => !kFunctions.has(name) && !known.has(name) && !/^e\d*$/i.test(name));
}

/** A divisor must not become zero: its minimum is above it. */
const divides = (formula: string, name: string) => new RegExp(`/\\s*${name}\\b`).test(formula);

/** Parameters that may be mistyped state variables: "v" where "v_m_s" is one. */
export function mistypedStates(
  draft: OwnDraft,
  states: readonly { readonly name: string }[],
): { readonly typed: string; readonly state: string }[] {
  return draft.parameters.flatMap(({ name }) => {
    const state = states.find((one) => nameAndUnit(one.name).name === name && one.name !== name);
    return state ? [{ typed: name, state: state.name }] : [];
  });
}

/** Keeps what was written of the parameters that stay, and adds those that came. */
export function withFormula(draft: OwnDraft, formula: string, states: readonly { readonly name: string }[]): OwnDraft {
  const parameters = parametersIn(formula, states).map(
    (name) =>
      draft.parameters.find((one) => one.name === name) ?? {
        name,
        unit: '1',
        initial: '1',
        low: divides(formula, name) ? '0.001' : '0',
        high: '1000',
      },
  );
  return { ...draft, formula, parameters };
}

/** The formula with a state variable in place of a name that was mistyped. */
export const withState = (formula: string, typed: string, state: string) =>
  formula.replace(/[A-Za-z_][A-Za-z0-9_]*/g, (name) => (name === typed ? state : name));

/** null while there is nothing to check yet: a mistyped state variable would be fitted as a constant. */
export function ownEffect(
  draft: OwnDraft,
  rig: Rig,
  list: Pick<EffectList, 'adds_to'> & { readonly states: readonly { readonly name: string }[] },
): OwnEffect | null {
  if (draft.formula.trim() === '' || draft.name.trim() === '' || mistypedStates(draft, list.states).length > 0)
    return null;
  const parameters = Object.fromEntries(
    draft.parameters.map(({ name, unit, initial, low, high }) => [
      name,
      { unit: unit.trim() === '' ? '1' : unit.trim(), initial: Number(initial), low: Number(low), high: Number(high) },
    ]),
  );
  return {
    format: 'tractus-effect/1',
    id: `expression:${draft.name.trim()}`,
    rig,
    adds_to: list.adds_to,
    formula: draft.formula.trim(),
    parameters,
  };
}
