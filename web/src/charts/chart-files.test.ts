// @vitest-environment jsdom
import { expect, it } from 'vitest';
import { csvText, svgText } from './chart-files';

it('writes the numbers of a chart with a header, quoted where RFC 4180 asks for it', async () => {
  const rows = [
    [1, 0.25, 'soft, cancellous'],
    [2, null, '=1+1'],
  ];
  // A cell that begins like a formula is kept from being one (OWASP, CSV injection).
  expect(await csvText({ columns: ['trial', 'share', 'case'], rows })).toBe(
    'trial,share,case\n1,0.25,"soft, cancellous"\n2,,"\'=1+1"',
  );
});

it('states in the file what a style sheet gave to the drawing', () => {
  document.body.innerHTML =
    '<style>.sum { stroke: rgb(1, 2, 3) }</style><svg width="10" height="10"><path class="sum" d="M0 0L1 1"/></svg>';
  const svg = document.querySelector('svg');
  if (!svg) throw new Error('no drawing');
  const file = new DOMParser().parseFromString(svgText(svg), 'image/svg+xml');
  const path = file.querySelector('path');
  expect(file.documentElement.namespaceURI).toBe('http://www.w3.org/2000/svg');
  expect(path?.getAttribute('style')).toContain('stroke: rgb(1, 2, 3)');
  expect(path?.hasAttribute('class')).toBe(false);
});
