/** What pictures in 3-D ask of the page. */
import { resolved } from './colour';
import type { Vec3 } from './scene/types';

/** A colour token as red, green, blue of 0 to 1. */
export function rgb(token: string): Vec3 {
  const [r = 128, g = 128, b = 128] = (resolved(token).match(/[\d.]+/g) ?? []).map(Number);
  return [r / 255, g / 255, b / 255];
}

/** Asked of a canvas of its own, before a megabyte of renderer is fetched for nothing. */
export function canDraw(): boolean {
  const context = document.createElement('canvas').getContext('webgl2');
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}
