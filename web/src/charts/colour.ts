/** Colours of the page's tokens as a canvas needs them: resolved for the theme that is shown, and kept until it changes. */
const known = new Map<string, string>();

/** To be called when the theme has changed. */
export const forgetColours = () => known.clear();

export function resolved(token: string): string {
  const found = known.get(token);
  if (found !== undefined) return found;
  const probe = document.createElement('span');
  probe.style.color = `var(${token})`;
  probe.style.display = 'none';
  document.body.append(probe);
  const colour = getComputedStyle(probe).color;
  probe.remove();
  known.set(token, colour);
  return colour;
}

/** Viridis at nine places (matplotlib, CC0): even in lightness, and read by the colour-blind. 0…255. */
const kViridis = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
] as const;

/** Red, green, blue of a share 0…1, each 0…1. */
export function viridis(share: number): [number, number, number] {
  const at = Math.min(Math.max(share, 0), 1) * (kViridis.length - 1);
  const low = Math.min(Math.floor(at), kViridis.length - 2);
  const [a, b] = [kViridis[low] ?? kViridis[0], kViridis[low + 1] ?? kViridis[0]];
  const mix = (i: 0 | 1 | 2) => (a[i] + (b[i] - a[i]) * (at - low)) / 255;
  return [mix(0), mix(1), mix(2)];
}
