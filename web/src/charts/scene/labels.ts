/** Names of the directions, as text over the picture: sharp at any size, and in the page's own type. */
import type vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';
import { kPerMetre, scaled, sum, type SceneTract, type Vec3 } from './types';

interface Label {
  readonly text: string;
  readonly at: Vec3;
  /** An end of the tract: its name would cover the mouth when looking along. */
  readonly end?: boolean;
}

/** Nearer to one another than this, the ends are one behind the other. */
const kApart_px = 48;

function placed(tract: SceneTract): Label[] {
  const out = (tract.radius_m + 0.011) * kPerMetre;
  const middle = sum(scaled(tract.entry_m), scaled(tract.axis, (tract.length_m * kPerMetre) / 2));
  const side = (direction: Vec3, sign: number) => sum(middle, scaled(direction, sign * out));
  return [
    { text: 'Medial', at: side(tract.medial, 1) },
    { text: 'Lateral', at: side(tract.medial, -1) },
    { text: 'Superior', at: side(tract.superior, 1) },
    { text: 'Inferior', at: side(tract.superior, -1) },
    {
      text: 'Anterior',
      at: sum(scaled(tract.entry_m), scaled(tract.axis, (tract.length_m + 0.006) * kPerMetre)),
      end: true,
    },
    { text: 'Entry', at: sum(scaled(tract.entry_m), scaled(tract.axis, -0.004 * kPerMetre)), end: true },
  ];
}

/** Returns what moves the labels to where the camera now sees their places. */
export function makeLabels(holder: HTMLElement, tract: SceneTract, renderer: vtkRenderer): () => void {
  const labels = placed(tract).map(({ text, at, end = false }) => {
    const element = document.createElement('span');
    element.textContent = text;
    holder.append(element);
    return { element, at, end };
  });
  return () => {
    const { clientWidth: width, clientHeight: height } = holder;
    if (width === 0 || height === 0) return;
    const places = labels.map(({ at }) => {
      const seen = renderer.worldToNormalizedDisplay(at[0], at[1], at[2], width / height);
      return { x: (seen[0] ?? 0) * width, y: (1 - (seen[1] ?? 0)) * height };
    });
    const [first, second] = places.filter((_, i) => labels[i]?.end);
    const covering = first && second && Math.hypot(first.x - second.x, first.y - second.y) < kApart_px;
    labels.forEach(({ element, end }, i) => {
      const { x, y } = places[i] ?? { x: 0, y: 0 };
      element.style.transform = `translate(-50%, -50%) translate(${x}px, ${y}px)`;
      element.hidden = end && covering === true;
    });
  };
}
