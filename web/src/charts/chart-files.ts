/** A chart as files: the drawing as SVG or PNG, its numbers as CSV. */

/** What a chart's files are called, and its numbers: one row a point. */
export interface ChartData {
  readonly name: string;
  readonly columns: readonly string[];
  readonly rows: readonly (readonly (string | number | null)[])[];
}

/** What a style sheet of the page gives to a drawing, and a file has to state itself. */
const kDrawn = [
  'fill',
  'fill-opacity',
  'stroke',
  'stroke-width',
  'stroke-dasharray',
  'stroke-linejoin',
  'stroke-opacity',
  'opacity',
  'font-family',
  'font-size',
  'font-weight',
  'text-anchor',
] as const;
const kPixelsPerPoint = 2;

/** The drawing as it looks, on the ground of the page. */
export function svgText(svg: SVGSVGElement): string {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  const shown = [svg, ...svg.querySelectorAll<SVGElement>('*')];
  [copy, ...copy.querySelectorAll<SVGElement>('*')].forEach((element, i) => {
    const from = shown[i];
    if (!from) return;
    const style = getComputedStyle(from);
    for (const name of kDrawn) element.style.setProperty(name, style.getPropertyValue(name));
    element.removeAttribute('class');
  });
  const ground = document.createElementNS('http://www.w3.org/2000/svg', 'rect');
  for (const [name, value] of [
    ['width', '100%'],
    ['height', '100%'],
    ['fill', getComputedStyle(document.body).backgroundColor],
  ] as const)
    ground.setAttribute(name, value);
  copy.prepend(ground);
  return new XMLSerializer().serializeToString(copy);
}

async function pngOf(svg: SVGSVGElement): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svgText(svg)], { type: 'image/svg+xml' }));
  try {
    const picture = new Image();
    picture.src = address;
    await picture.decode();
    const canvas = document.createElement('canvas');
    canvas.width = svg.clientWidth * kPixelsPerPoint;
    canvas.height = svg.clientHeight * kPixelsPerPoint;
    canvas.getContext('2d')?.drawImage(picture, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve, reject) =>
      canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the picture cannot be drawn')))),
    );
  } finally {
    URL.revokeObjectURL(address);
  }
}

export async function csvText({ columns, rows }: Pick<ChartData, 'columns' | 'rows'>): Promise<string> {
  const { unparse } = await import('papaparse');
  return unparse({ fields: [...columns], data: rows.map((row) => [...row]) }, { newline: '\n', escapeFormulae: true });
}

export const kChartFiles = ['SVG', 'PNG', 'CSV'] as const;

/** Hands one of the files to the browser, which saves it. */
export async function saveChart(
  kind: (typeof kChartFiles)[number],
  svg: SVGSVGElement,
  data: ChartData,
): Promise<void> {
  const blob =
    kind === 'PNG'
      ? await pngOf(svg)
      : kind === 'SVG'
        ? new Blob([svgText(svg)], { type: 'image/svg+xml' })
        : new Blob([await csvText(data)], { type: 'text/csv' });
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = `${data.name}.${kind.toLowerCase()}`;
  link.click();
  URL.revokeObjectURL(link.href);
}
