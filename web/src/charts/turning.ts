import { useEffect, type KeyboardEvent, type RefObject } from 'react';

interface Turned {
  turn(azimuth: number, elevation: number): void;
  zoom(factor: number): void;
}

/** Arrow keys turn by ten degrees, + and - zoom, 0 begins anew. */
export function turnByKey(event: KeyboardEvent, scene: Turned | null, reset: () => void): void {
  const act: Record<string, (() => void) | undefined> = {
    ArrowLeft: () => scene?.turn(10, 0),
    ArrowRight: () => scene?.turn(-10, 0),
    ArrowUp: () => scene?.turn(0, -10),
    ArrowDown: () => scene?.turn(0, 10),
    '+': () => scene?.zoom(1.15),
    '=': () => scene?.zoom(1.15),
    '-': () => scene?.zoom(1 / 1.15),
    '0': reset,
  };
  const done = act[event.key];
  if (!done || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  done();
}

/** Draws the scene anew when its place on the page has another size. */
export function useResized(scene: { resize(): void } | null, place: RefObject<HTMLElement | null>): void {
  useEffect(() => {
    if (!scene || !place.current) return;
    const observer = new ResizeObserver(() => scene.resize());
    observer.observe(place.current);
    return () => observer.disconnect();
  }, [scene, place]);
}
