// @vitest-environment jsdom
import { cleanup, render, screen } from '@testing-library/react';
import { act, useRef, useState } from 'react';
import { afterEach, expect, it, vi } from 'vitest';
import { useWheel } from './use-navigation';

afterEach(cleanup);

const kDuration_s = 60;
function Chart() {
  const place = useRef<HTMLDivElement>(null);
  const [range, onRange] = useState({ from: 0, to: kDuration_s });
  useWheel(place, { range, duration_s: kDuration_s, onRange });
  return (
    <div ref={place}>
      <div className="uplot" data-testid="chart">
        <div className="u-over" />
      </div>
      <output>{range.to - range.from}</output>
    </div>
  );
}

it('counts every turn of the wheel, also those that come before the last one is drawn', () => {
  vi.spyOn(Element.prototype, 'getBoundingClientRect').mockReturnValue({ left: 0, width: 1000 } as DOMRect);
  render(<Chart />);
  const turn = () =>
    screen
      .getByTestId('chart')
      .dispatchEvent(new WheelEvent('wheel', { deltaY: -100, ctrlKey: true, bubbles: true, cancelable: true }));
  act(() => {
    for (let count = 0; count < 12; ++count) turn();
  });
  // 12 turns by 100 px, each by e^0.16.
  expect(Number(screen.getByRole('status').textContent)).toBeCloseTo(kDuration_s / Math.exp(12 * 0.16), 6);
});
