import { useEffect, useRef, useState, type KeyboardEvent, type ReactNode } from 'react';
import { formatForce, newton } from '@/units';
import { viridis } from './colour';
import type { Cursor } from './cursor';
import { canDraw, rgb } from './draw';
import type { Scene } from './scene';
import type { SceneBone, ScenePath, SceneTract, ViewName } from './scene/types';
import styles from './tract-view.module.css';

interface Props {
  readonly tract: SceneTract;
  readonly path: ScenePath;
  /** null where the bone could not be fetched: the rest is drawn without it. */
  readonly bone: SceneBone | null;
  readonly cursor: Cursor;
  /** Another trial on the same case, and its moment that goes with a moment of this one. */
  readonly ghost?: { readonly path: ScenePath; readonly at: (t_s: number) => number } | null;
  readonly palette: number;
  readonly summary: string;
  readonly button: (label: string, text: string, press: () => void, pressed?: boolean) => ReactNode;
}

const kViews: readonly { name: ViewName; text: string; label: string }[] = [
  { name: 'start', text: 'Reset', label: 'Reset the view' },
  { name: 'superior', text: 'Superior', label: 'Look from superior' },
  { name: 'medial', text: 'Medial', label: 'Look from medial' },
  { name: 'along', text: 'Along', label: 'Look along the tract, as the surgeon does' },
];

const kScale = `linear-gradient(to right, ${Array.from({ length: 9 }, (_, i) => `rgb(${viridis(i / 8).map((c) => Math.round(c * 255)).join(' ')})`).join(', ')})`;

/** Top of the colour scale: above all but the strongest twentieth, so that a few taps do not darken the rest. */
function topOf(force_N: readonly number[]): number {
  const sorted = [...force_N].sort((a, b) => a - b);
  return Math.max(sorted[Math.floor(0.95 * (sorted.length - 1))] ?? 0, 0.05);
}

/** The tract, the bone round it and the way of the tip, to be turned about. */
export function TractView({ tract, path, bone, cursor, ghost = null, palette, summary, button }: Props) {
  const stage = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLDivElement>(null);
  const labels = useRef<HTMLDivElement>(null);
  const [scene, setScene] = useState<Scene | null>(null);
  const [failure, setFailure] = useState('');
  const [shown, setShown] = useState<'cut' | 'whole' | 'none'>('cut');
  const most_N = topOf(path.force_N);
  const ghostPath = ghost?.path ?? null, ghostAt = ghost?.at ?? null;

  useEffect(() => {
    const place = canvas.current, holder = labels.current;
    if (!place || !holder) return;
    let gone = false;
    let made: Scene | null = null;
    const fail = () => setFailure('The picture in 3-D could not be drawn.');
    const start = async () => {
      if (!canDraw()) { setFailure('This browser offers no WebGL 2, so the picture in 3-D cannot be drawn.'); return; }
      const { makeScene } = await import('./scene');
      if (gone) return;
      made = makeScene(place, holder, { tract, path, bone, most_N, ghost: ghostPath });
      place.querySelector('canvas')?.addEventListener('webglcontextlost', () => {
        if (!gone) setFailure('The graphics processor has dropped the picture. Reload the page to draw it again.');
      });
      setScene(made);
    };
    start().catch(fail);
    return () => { gone = true; made?.destroy(); setScene(null); };
  }, [tract, path, bone, most_N, ghostPath]);

  useEffect(() => {
    scene?.colour({ bone: rgb('--bone'), tract: rgb('--accent'), moment: rgb('--series-across'), ghost: rgb('--event') });
  }, [scene, palette]);
  useEffect(() => { scene?.bone(shown !== 'none', shown === 'cut'); }, [scene, shown]);
  useEffect(() => {
    if (!scene) return;
    const follow = () => {
      const now = cursor.now();
      scene.moment(now);
      scene.ghost(now === null || !ghostAt ? null : ghostAt(now));
    };
    follow();
    return cursor.subscribe(follow);
  }, [scene, cursor, ghostAt]);
  useEffect(() => {
    if (!scene || !canvas.current) return;
    const observer = new ResizeObserver(() => scene.resize());
    observer.observe(canvas.current);
    return () => observer.disconnect();
  }, [scene]);

  // The wheel belongs to the page until the picture has the focus.
  useEffect(() => {
    const element = stage.current;
    const onWheel = (event: WheelEvent) => {
      if (!event.ctrlKey && !element?.contains(document.activeElement)) event.stopPropagation();
    };
    element?.addEventListener('wheel', onWheel, { capture: true });
    return () => element?.removeEventListener('wheel', onWheel, { capture: true });
  }, []);

  const onKeyDown = (event: KeyboardEvent) => {
    const act: Record<string, (() => void) | undefined> = {
      ArrowLeft: () => scene?.turn(10, 0), ArrowRight: () => scene?.turn(-10, 0), ArrowUp: () => scene?.turn(0, -10), ArrowDown: () => scene?.turn(0, 10),
      '+': () => scene?.zoom(1.15), '=': () => scene?.zoom(1.15), '-': () => scene?.zoom(1 / 1.15), '0': () => scene?.look('start'),
    };
    const done = act[event.key];
    if (!done || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    done();
  };

  return (
    <figure className={styles.figure}>
      <div className={styles.tools} role="group" aria-label="View of the tract">
        {kViews.map(({ name, text, label }) => <span key={name}>{button(label, text, () => scene?.look(name))}</span>)}
        <span className={styles.gap} />
        {bone ? (
          <>
            {button('Cut open: without the superior half of the bone', 'Cut open', () => setShown('cut'), shown === 'cut')}
            {button('Whole bone', 'Whole', () => setShown('whole'), shown === 'whole')}
            {button('No bone', 'No bone', () => setShown('none'), shown === 'none')}
          </>
        ) : null}
      </div>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <div
        ref={stage} className={styles.stage} role="application" aria-roledescription="3-D picture" aria-label={summary} data-part="scene" data-ready={scene !== null || undefined}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0} onKeyDown={onKeyDown} onPointerDown={() => stage.current?.focus({ preventScroll: true })}
      >
        <div ref={canvas} className={styles.canvas} hidden={failure !== ''} />
        <div ref={labels} className={styles.labels} aria-hidden="true" hidden={failure !== ''} />
        {failure !== '' ? <p className={styles.failure} role="alert">{failure} Everything else on this page is complete without it.</p> : null}
        {failure === '' && scene === null ? <p className={styles.failure} role="status">Drawing…</p> : null}
      </div>
      <figcaption className={styles.caption}>
        <span className={styles.scale}>
          force on the tip 0<i style={{ background: kScale }} />{formatForce(newton(most_N))} and above
        </span>
        <span className={styles.hint}>Drag to turn, Shift-drag to move, wheel after a click to zoom. Arrow keys turn.</span>
      </figcaption>
    </figure>
  );
}
