import { useEffect, useRef, type PointerEvent } from 'react';
import { resolved } from './colour';
import { clamp, type Range } from './range';
import styles from './signal-chart.module.css';
import type { Detail } from './tiles';

interface Props {
  readonly detail: Detail;
  readonly channel: string;
  readonly colour: string;
  readonly duration_s: number;
  readonly range: Range;
  readonly width_px: number;
  readonly palette: number;
  readonly onRange: (range: Range) => void;
}

const kHeight_px = 36;

function draw(canvas: HTMLCanvasElement, { detail, channel, colour, duration_s, width_px }: Props): void {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width_px * ratio);
  canvas.height = Math.round(kHeight_px * ratio);
  const pen = canvas.getContext('2d');
  const greatest = detail.channels[channel]?.max ?? [];
  if (!pen || !(duration_s > 0)) return;
  const top = greatest.reduce<number>((most, value) => Math.max(most, value ?? 0), 1e-9);
  pen.fillStyle = resolved(colour);
  greatest.forEach((value, i) => {
    const x = ((detail.t[i] ?? 0) / duration_s) * canvas.width;
    const next = ((detail.t[i + 1] ?? duration_s) / duration_s) * canvas.width;
    const height = ((value ?? 0) / top) * (canvas.height - 4 * ratio);
    pen.fillRect(x, canvas.height - height, Math.max(next - x, 1), height);
  });
}

/** The whole trial in small, with a window on what is shown: drag the window, or press where it shall be. */
export function OverviewStrip(props: Props) {
  const { detail, channel, colour, duration_s, range, width_px, palette, onRange } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const grip = useRef<number | null>(null);

  useEffect(() => {
    if (canvas.current && width_px > 0) draw(canvas.current, props);
    // eslint-disable-next-line react-hooks/exhaustive-deps -- the view moves the window alone, not the drawing
  }, [detail, channel, colour, duration_s, width_px, palette]);

  const moment = (event: PointerEvent<HTMLElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    return ((event.clientX - box.left) / box.width) * duration_s;
  };
  const moveTo = (from: number) => onRange(clamp({ from, to: from + range.to - range.from }, duration_s));
  const onPointerDown = (event: PointerEvent<HTMLElement>) => {
    const at = moment(event);
    const held = at >= range.from && at <= range.to;
    grip.current = held ? at - range.from : (range.to - range.from) / 2;
    event.currentTarget.setPointerCapture(event.pointerId);
    if (!held) moveTo(at - grip.current);
  };
  const share = (t: number) => `${(t / duration_s) * 100}%`;

  return (
    <div
      className={styles.overview}
      aria-hidden="true"
      data-part="overview"
      onPointerDown={onPointerDown}
      onPointerMove={(event) => {
        if (grip.current !== null) moveTo(moment(event) - grip.current);
      }}
      onPointerUp={() => {
        grip.current = null;
      }}
      onPointerCancel={() => {
        grip.current = null;
      }}
    >
      <canvas ref={canvas} style={{ width: width_px, height: kHeight_px }} />
      <div className={styles.window} style={{ left: share(range.from), width: share(range.to - range.from) }} />
    </div>
  );
}
