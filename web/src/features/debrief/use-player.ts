import { useCallback, useEffect, useRef, useState } from 'react';
import type { Cursor } from '@/charts';

export const kSpeeds = [0.25, 0.5, 1, 2, 4] as const;

export interface Player {
  readonly playing: boolean;
  readonly speed: number;
  readonly toggle: () => void;
  readonly setSpeed: (speed: number) => void;
  /** Goes to a moment; play goes on from there. */
  readonly seek: (t_s: number) => void;
}

/** Moves the cursor as time goes by. The drawings follow the cursor, so a frame costs no drawing of the page. */
export function usePlayer(duration_s: number, cursor: Cursor): Player {
  const [playing, setPlaying] = useState(false);
  const [speed, setSpeed] = useState(1);
  const rate = useRef(speed);
  useEffect(() => {
    rate.current = speed;
  }, [speed]);
  useEffect(() => {
    if (cursor.now() === null) cursor.set(0);
  }, [cursor]);
  useEffect(() => {
    if (!playing) return;
    let before = performance.now();
    let frame = requestAnimationFrame(function go(now) {
      const next = (cursor.now() ?? 0) + ((now - before) / 1000) * rate.current;
      before = now;
      cursor.set(Math.min(next, duration_s));
      if (next >= duration_s) setPlaying(false);
      else frame = requestAnimationFrame(go);
    });
    return () => cancelAnimationFrame(frame);
  }, [playing, cursor, duration_s]);
  const seek = useCallback((t_s: number) => cursor.set(Math.min(Math.max(t_s, 0), duration_s)), [cursor, duration_s]);
  const toggle = useCallback(() => {
    if (!playing && (cursor.now() ?? 0) >= duration_s) cursor.set(0);
    setPlaying(!playing);
  }, [playing, cursor, duration_s]);
  return { playing, speed, toggle, setSpeed, seek };
}
