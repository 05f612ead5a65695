import { useEffect, useId, useRef, useState, type KeyboardEvent, type PointerEvent } from 'react';
import { say } from '@/language';
import { formatLength, metre } from '@/units';
import type { CutLine } from './mesh-cut';
import type { Vec3 } from './scene/types';
import { Balls, BrushRings, Marks, Outline } from './slice-drawing';
import {
  inPlane,
  letterAt,
  onPlane,
  stroke,
  type SliceBall,
  type SliceBrush,
  type SliceMark,
  type SlicePicture,
} from './slice-places';
import styles from './slice-view.module.css';

interface Props {
  /** "Axial": the plane's name for a person. */
  readonly name: string;
  /** null while the first is on its way. */
  readonly picture: SlicePicture | null;
  /** The one shown is not the one asked for yet. */
  readonly late: boolean;
  /** How much larger than its place the picture is; scrolled where it is larger. */
  readonly zoom?: number;
  readonly at_m: number;
  readonly from_m: number;
  readonly to_m: number;
  /** What the ends of the slider mean: "feet", "head". */
  readonly ends: readonly [string, string];
  readonly marks: readonly SliceMark[];
  /** The mark that a click places and that the arrow keys move. */
  readonly chosen: string;
  /** Lines in the plane, as where it cuts a surface. */
  readonly outline?: readonly CutLine[];
  readonly balls?: readonly SliceBall[];
  /** Clicks, drags and keys paint with it instead of placing the mark. */
  readonly brush?: SliceBrush | null;
  readonly onAt: (at_m: number) => void;
  readonly onPlace: (id: string, at: Vec3, done: boolean) => void;
}

const kStep_m = 0.0005,
  kFine_m = 0.0001;
const kNone: readonly never[] = [];

/** Drawn once a picture: grey pixels, as they came. */
function paint(canvas: HTMLCanvasElement, { width, height, pixels }: SlicePicture): void {
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  if (!context) return;
  const image = context.createImageData(width, height);
  for (let i = 0; i < pixels.length; ++i) {
    const value = pixels[i] ?? 0;
    image.data[4 * i] = image.data[4 * i + 1] = image.data[4 * i + 2] = value;
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}

/** What a click and the keys do in the slice, for who cannot see it. */
function labelOf(name: string, mark: string, brush: SliceBrush | null): string {
  if (!brush)
    return say(
      '{name} slice. Click or drag places the {mark}; arrow keys move it by half a millimetre, with Shift by a tenth; Page Up and Page Down change the slice.',
      { name, mark },
    );
  if (brush.sign === '×')
    return say(
      '{name} slice. Click or drag removes marks; arrow keys move the brush by half a millimetre, with Shift by a tenth; Enter removes; Page Up and Page Down change the slice.',
      { name },
    );
  return brush.sign === '+'
    ? say(
        '{name} slice. Click or drag marks where bone is; arrow keys move the brush by half a millimetre, with Shift by a tenth; Enter paints; Page Up and Page Down change the slice.',
        { name },
      )
    : say(
        '{name} slice. Click or drag marks where no bone is; arrow keys move the brush by half a millimetre, with Shift by a tenth; Enter paints; Page Up and Page Down change the slice.',
        { name },
      );
}

/** A plane of a volume with marks that can be clicked, dragged and moved by keys. */
export function SliceView({
  name,
  picture,
  late,
  zoom = 1,
  at_m,
  from_m,
  to_m,
  ends,
  marks,
  chosen,
  outline = kNone,
  balls = kNone,
  brush = null,
  onAt,
  onPlace,
}: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const drawing = useRef<SVGSVGElement>(null);
  const dragged = useRef<string | null>(null);
  const painted = useRef<Vec3 | null>(null); // the last place of the stroke that is going on
  const [hover, setHover] = useState<Vec3 | null>(null);
  const id = useId();
  useEffect(() => {
    if (canvas.current && picture) paint(canvas.current, picture);
  }, [picture]);

  const placeOf = (event: PointerEvent): Vec3 | null => {
    const matrix = drawing.current?.getScreenCTM();
    if (!matrix || !picture) return null;
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    return onPlane(picture, x, y);
  };
  const begin = (event: PointerEvent<SVGSVGElement>) => {
    if (event.button !== 0) return;
    const at = placeOf(event);
    if (!at) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    if (brush) {
      painted.current = at;
      brush.onPaint(at, true);
      return;
    }
    const mark =
      event.target instanceof Element ? event.target.closest('[data-mark]')?.getAttribute('data-mark') : undefined;
    dragged.current = mark ?? chosen;
    if (!mark) onPlace(chosen, at, false);
  };
  const paintTo = (at: Vec3 | null) => {
    if (!brush || !at || !painted.current) return;
    for (const place of stroke(painted.current, at, brush.radius_m / 2)) {
      brush.onPaint(place, false);
      painted.current = place;
    }
  };
  const move = (event: PointerEvent) => {
    if (brush) {
      const under = placeOf(event);
      setHover(under);
      paintTo(under);
      return;
    }
    const at = dragged.current === null ? null : placeOf(event);
    if (at && dragged.current !== null) onPlace(dragged.current, at, false);
  };
  const end = (event: PointerEvent) => {
    if (brush && painted.current) {
      paintTo(placeOf(event));
      brush.onCursor(painted.current);
    }
    painted.current = null;
    const at = dragged.current === null ? null : placeOf(event);
    if (at && dragged.current !== null) onPlace(dragged.current, at, true);
    dragged.current = null;
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (!picture || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? kFine_m : kStep_m;
    if (event.key === 'PageUp' || event.key === 'PageDown') {
      event.preventDefault();
      onAt(Math.min(Math.max(at_m + (event.key === 'PageUp' ? 2 : -2) * kStep_m, from_m), to_m));
      return;
    }
    const moves: Record<string, readonly [number, number] | undefined> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const moved = moves[event.key];
    const from = brush ? inPlane(picture, brush.cursor) : marks.find((one) => one.id === chosen)?.at;
    if (from && brush && event.key === 'Enter') {
      event.preventDefault();
      brush.onPaint(from, true);
    }
    if (!moved || !from) return;
    event.preventDefault();
    const along = (i: 0 | 1 | 2) =>
      from[i] + step * (moved[0] * picture.alongRow[i] + moved[1] * picture.alongColumn[i]);
    const to: Vec3 = [along(0), along(1), along(2)];
    if (brush) brush.onCursor(to);
    else onPlace(chosen, to, true);
  };

  return (
    <div className={styles.view} data-plane={name.toLowerCase()} data-ready={(picture !== null && !late) || undefined}>
      <div className={styles.head}>
        <h3 id={id}>{say(name)}</h3>
        <span className={styles.at}>{formatLength(metre(at_m))}</span>
      </div>
      <div className={styles.frame}>
        <div className={styles.window}>
          <div className={styles.inner} style={{ width: `${100 * zoom}%`, height: `${100 * zoom}%` }}>
            <canvas ref={canvas} className={styles.picture} aria-hidden="true" hidden={picture === null} />
            {picture ? (
              <svg
                ref={drawing}
                className={styles.drawing}
                viewBox={`0 0 ${picture.width} ${picture.height}`}
                role="application"
                aria-roledescription={say('slice')}
                aria-label={labelOf(say(name), chosen, brush)}
                tabIndex={0}
                onKeyDown={onKeyDown}
                onPointerDown={begin}
                onPointerMove={move}
                onPointerUp={end}
                onPointerLeave={() => setHover(null)}
                onPointerCancel={() => {
                  dragged.current = painted.current = null;
                }}
                data-brush={brush ? true : undefined}
              >
                <Outline lines={outline} picture={picture} />
                <Balls balls={balls} picture={picture} />
                <Marks marks={marks} chosen={chosen} picture={picture} />
                {brush ? <BrushRings brush={brush} hover={hover} picture={picture} /> : null}
              </svg>
            ) : (
              <p className={styles.waiting} role="status">
                {say('Loading…')}
              </p>
            )}
          </div>
        </div>
        {picture
          ? (['left', 'right', 'top', 'bottom'] as const).map((edge) => (
              <span key={edge} className={`${styles.letter} ${styles[edge]}`} aria-hidden="true">
                {letterAt(picture, edge)}
              </span>
            ))
          : null}
      </div>
      <label className={styles.slider}>
        <span className="hidden-visually">
          {say('{name} slice, from {first} to {last}', { name: say(name), first: ends[0], last: ends[1] })}
        </span>
        <span aria-hidden="true">{ends[0]}</span>
        <input
          type="range"
          min={from_m}
          max={to_m}
          step={kStep_m}
          value={at_m}
          aria-valuetext={formatLength(metre(at_m))}
          onChange={(event) => onAt(Number(event.target.value))}
        />
        <span aria-hidden="true">{ends[1]}</span>
      </label>
    </div>
  );
}
