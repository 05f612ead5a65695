import { useEffect, useId, useRef, type KeyboardEvent, type PointerEvent } from 'react';
import { say } from '@/language';
import { formatLength, metre } from '@/units';
import { letterAt, onPlane, onSlice, type SlicePicture, type SliceMark } from './slice-places';
import type { Vec3 } from './scene/types';
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
  readonly onAt: (at_m: number) => void;
  readonly onPlace: (id: string, at: Vec3, done: boolean) => void;
}

const kStep_m = 0.0005,
  kFine_m = 0.0001;
const kFar_m = 0.003; // farther from the plane than this, a mark is a shadow

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
  onAt,
  onPlace,
}: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const drawing = useRef<SVGSVGElement>(null);
  const dragged = useRef<string | null>(null);
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
    const mark =
      event.target instanceof Element ? event.target.closest('[data-mark]')?.getAttribute('data-mark') : undefined;
    dragged.current = mark ?? chosen;
    event.currentTarget.setPointerCapture(event.pointerId);
    if (!mark) onPlace(chosen, at, false);
  };
  const move = (event: PointerEvent) => {
    const at = dragged.current === null ? null : placeOf(event);
    if (at && dragged.current !== null) onPlace(dragged.current, at, false);
  };
  const end = (event: PointerEvent) => {
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
    const mark = marks.find((one) => one.id === chosen);
    if (!moved || !mark) return;
    event.preventDefault();
    const along = (i: 0 | 1 | 2) =>
      mark.at[i] + step * (moved[0] * picture.alongRow[i] + moved[1] * picture.alongColumn[i]);
    onPlace(chosen, [along(0), along(1), along(2)], true);
  };

  const scale = picture ? Math.max(picture.width, picture.height) / 100 : 1;
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
                aria-label={say(
                  '{name} slice. Click or drag places the {mark}; arrow keys move it by half a millimetre, with Shift by a tenth; Page Up and Page Down change the slice.',
                  { name: say(name), mark: chosen },
                )}
                tabIndex={0}
                onKeyDown={onKeyDown}
                onPointerDown={begin}
                onPointerMove={move}
                onPointerUp={end}
                onPointerCancel={() => {
                  dragged.current = null;
                }}
              >
                {marks.map((mark) => {
                  const here = onSlice(picture, mark.at),
                    there = mark.to ? onSlice(picture, mark.to) : null;
                  const far = Math.abs(here.off_m) > kFar_m;
                  return there ? (
                    <line
                      key={mark.id}
                      className={styles[mark.look]}
                      x1={here.x}
                      y1={here.y}
                      x2={there.x}
                      y2={there.y}
                      strokeWidth={(mark.wide ?? 0.6) * scale}
                    />
                  ) : (
                    <g
                      key={mark.id}
                      className={styles[mark.look]}
                      data-mark={mark.fixed ? undefined : mark.id}
                      data-far={far || undefined}
                      data-chosen={mark.id === chosen || undefined}
                    >
                      <circle className={styles.grip} cx={here.x} cy={here.y} r={3.4 * scale} />
                      <circle
                        className={styles.dot}
                        cx={here.x}
                        cy={here.y}
                        r={1.5 * scale}
                        strokeWidth={0.6 * scale}
                      />
                      {mark.text === undefined ? null : (
                        <text
                          x={here.x + 2.6 * scale}
                          y={here.y - 2 * scale}
                          fontSize={4.2 * scale}
                          strokeWidth={0.9 * scale}
                        >
                          {mark.text}
                        </text>
                      )}
                    </g>
                  );
                })}
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
