/** Two versions of a model, number by number. Pure. */
export interface Difference {
  readonly name: string;
  readonly a: number | null;
  readonly b: number | null;
}

type Numbers = Map<string, number>;

function gather(value: unknown, path: string, into: Numbers): void {
  if (typeof value === 'number') into.set(path, value);
  else if (Array.isArray(value)) value.forEach((one, i) => gather(one, `${path}/${i}`, into));
  else if (typeof value === 'object' && value !== null)
    for (const [key, one] of Object.entries(value)) gather(one, `${path}/${key}`, into);
}

/** Every number of a model file by its pointer: "/base/…" and "ID/parameter". */
export function numbersOf(file: Readonly<Record<string, unknown>>): Numbers {
  const found: Numbers = new Map();
  gather(file.base, '/base', found);
  const effects = Array.isArray(file.effects) ? (file.effects as unknown[]) : [];
  for (const effect of effects) {
    if (typeof effect !== 'object' || effect === null) continue;
    const { id, parameters } = effect as { id?: unknown; parameters?: unknown };
    gather(parameters, String(id), found);
  }
  return found;
}

/** What one has and the other has not, and what is not the same in both; a is null where the number is new. */
export function differences(a: Readonly<Record<string, unknown>>, b: Readonly<Record<string, unknown>>): Difference[] {
  const was = numbersOf(a),
    is = numbersOf(b);
  const names = [...new Set([...was.keys(), ...is.keys()])];
  return names
    .map((name) => ({ name, a: was.get(name) ?? null, b: is.get(name) ?? null }))
    .filter(({ a: x, b: y }) => x !== y);
}
