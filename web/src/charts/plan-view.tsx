import { useEffect, useRef, useState, type KeyboardEvent, type ReactNode } from 'react';
import { canDraw, rgb } from './draw';
import type { Scene } from './scene';
import type { SceneBone, SceneBreach, SceneTract, ViewName } from './scene/types';
import styles from './tract-view.module.css';

interface Props {
  /** null: the bone alone is shown, as none is planned yet. */
  readonly tract: SceneTract | null;
  readonly breach: SceneBreach | null;
  /** null where it could not be fetched. */
  readonly bone: SceneBone | null;
  readonly palette: number;
  readonly summary: string;
  readonly button: (label: string, text: string, press: () => void, pressed?: boolean) => ReactNode;
}

const kNoPath = { t_s: [], tip_m: [], force_N: [] } as const;
const kViews: readonly { name: ViewName; text: string; label: string }[] = [
  { name: 'start', text: 'Reset', label: 'Reset the view' },
  { name: 'superior', text: 'Superior', label: 'Look from superior' },
  { name: 'medial', text: 'Medial', label: 'Look from medial' },
  { name: 'along', text: 'Along', label: 'Look along the tract, as the surgeon does' },
];

/** Without a tract: through the middle of the bone, from behind, so that the view has somewhere to look. */
function throughTheMiddle(bone: SceneBone): SceneTract {
  const d = bone.directions;
  const half = bone.dims.map((n, i) => ((n - 1) / 2) * (bone.spacing_m[i] ?? 0));
  const middle = ([0, 1, 2] as const).map((row) => bone.origin_m[row] + [0, 1, 2].reduce((total, i) => total + (d[3 * row + i] ?? 0) * (half[i] ?? 0), 0));
  return { entry_m: [middle[0] ?? 0, (middle[1] ?? 0) + 0.03, middle[2] ?? 0], axis: [0, -1, 0], length_m: 0.06, radius_m: 0.0015, medial: [1, 0, 0], superior: [0, 0, 1] };
}

/** A planned tract and its breach in the bone, to be turned about. */
export function PlanView({ tract, breach, bone, palette, summary, button }: Props) {
  const stage = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLDivElement>(null);
  const labels = useRef<HTMLDivElement>(null);
  const [scene, setScene] = useState<Scene | null>(null);
  const [failure, setFailure] = useState('');
  const [shown, setShown] = useState<'cut' | 'whole' | 'none'>('cut');

  useEffect(() => {
    const place = canvas.current, holder = labels.current;
    const at = tract ?? (bone ? throughTheMiddle(bone) : null);
    if (!place || !holder || !at) return;
    let gone = false;
    let made: Scene | null = null;
    const start = async () => {
      if (!canDraw()) { setFailure('This browser offers no WebGL 2, so the picture in 3-D cannot be drawn.'); return; }
      const { makeScene } = await import('./scene');
      if (gone) return;
      made = makeScene(place, holder, { tract: at, path: kNoPath, bone, most_N: 1, breach, bare: tract === null });
      setScene(made);
    };
    start().catch(() => setFailure('The picture in 3-D could not be drawn.'));
    return () => { gone = true; made?.destroy(); setScene(null); };
  }, [tract, breach, bone]);
  useEffect(() => { scene?.colour({ bone: rgb('--bone'), tract: rgb('--accent'), moment: rgb('--bad') }); }, [scene, palette]);
  useEffect(() => { scene?.bone(shown !== 'none', shown === 'cut' && tract !== null); }, [scene, shown, tract]);
  useEffect(() => {
    if (!scene || !canvas.current) return;
    const observer = new ResizeObserver(() => scene.resize());
    observer.observe(canvas.current);
    return () => observer.disconnect();
  }, [scene]);
  useEffect(() => {
    const element = stage.current;
    const onWheel = (event: WheelEvent) => { if (!event.ctrlKey && !element?.contains(document.activeElement)) event.stopPropagation(); };
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
      <div className={styles.tools} role="group" aria-label="View of the bone">
        {kViews.map(({ name, text, label }) => <span key={name}>{button(label, text, () => scene?.look(name))}</span>)}
        <span className={styles.gap} />
        {button('Cut open: without the superior half of the bone', 'Cut open', () => setShown('cut'), shown === 'cut')}
        {button('Whole bone', 'Whole', () => setShown('whole'), shown === 'whole')}
        {button('No bone', 'No bone', () => setShown('none'), shown === 'none')}
      </div>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <div ref={stage} className={styles.stage} role="application" aria-roledescription="3-D picture" aria-label={summary} data-part="scene" data-ready={scene !== null || undefined}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0} onKeyDown={onKeyDown} onPointerDown={() => stage.current?.focus({ preventScroll: true })}>
        <div ref={canvas} className={styles.canvas} hidden={failure !== ''} />
        <div ref={labels} className={styles.labels} aria-hidden="true" hidden={failure !== ''} />
        {failure !== '' ? <p className={styles.failure} role="alert">{failure} Everything else on this page is complete without it.</p> : null}
        {failure === '' && scene === null ? <p className={styles.failure} role="status">Drawing…</p> : null}
      </div>
      <figcaption className={styles.caption}><span className={styles.hint}>Drag to turn, Shift-drag to move, wheel after a click to zoom. Arrow keys turn.</span></figcaption>
    </figure>
  );
}
