/** Wheel and keys that move the view of a chart. */
import { useEffect, useRef, type KeyboardEvent, type RefObject } from 'react';
import { panned, whole, zoomed, type Range } from './range';

interface View {
  readonly range: Range;
  readonly duration_s: number;
  readonly onRange: (range: Range) => void;
}

const kWheelZoom = 0.0016;

/** The wheel zooms about the pointer while the chart has the focus or Ctrl is held; else the page scrolls as ever. */
export function useWheel(place: RefObject<HTMLElement | null>, view: View): void {
  const latest = useRef(view);
  useEffect(() => {
    latest.current = view;
  });
  useEffect(() => {
    const element = place.current;
    if (!element) return;
    const onWheel = (event: WheelEvent) => {
      const { range, duration_s } = latest.current;
      // The next turn of the wheel may come before this one is drawn, and goes on from it.
      const show = (next: Range) => {
        event.preventDefault();
        latest.current = { ...latest.current, range: next };
        latest.current.onRange(next);
      };
      const over = (event.target as Element).closest?.('.uplot')?.querySelector('.u-over');
      if (!over) return;
      const box = over.getBoundingClientRect();
      const sideways = event.shiftKey ? event.deltaY || event.deltaX : event.deltaX;
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        show(panned(range, sideways / box.width, duration_s));
      } else if (event.ctrlKey || event.metaKey || element.contains(document.activeElement)) {
        const place01 = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
        show(
          zoomed(
            range,
            Math.exp(event.deltaY * kWheelZoom),
            range.from + place01 * (range.to - range.from),
            duration_s,
          ),
        );
      }
    };
    element.addEventListener('wheel', onWheel, { passive: false });
    return () => element.removeEventListener('wheel', onWheel);
  }, [place]);
}

/** What a key does to the view; undefined for keys that are not ours. */
export function keyed(key: string, range: Range, duration: number): Range | undefined {
  const middle = (range.from + range.to) / 2;
  const span = range.to - range.from;
  switch (key) {
    case 'ArrowLeft':
      return panned(range, -0.1, duration);
    case 'ArrowRight':
      return panned(range, 0.1, duration);
    case 'PageUp':
      return panned(range, -0.9, duration);
    case 'PageDown':
      return panned(range, 0.9, duration);
    case '+':
    case '=':
    case 'ArrowUp':
      return zoomed(range, 1 / 1.5, middle, duration);
    case '-':
    case 'ArrowDown':
      return zoomed(range, 1.5, middle, duration);
    case 'Home':
      return { from: 0, to: span };
    case 'End':
      return { from: duration - span, to: duration };
    case '0':
    case 'Escape':
      return whole(duration);
    default:
      return undefined;
  }
}

export function onNavigationKey(event: KeyboardEvent, { range, duration_s, onRange }: View): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const next = keyed(event.key, range, duration_s);
  if (!next) return;
  event.preventDefault();
  onRange(next);
}
