import { useEffect, useRef, useState, type ReactNode } from 'react';
import { marked, say } from '@/language';
import { canDraw, rgb } from './draw';
import type { Looks, Scene, SceneContent } from './scene';
import type { SceneColours, ViewName } from './scene/types';
import styles from './tract-view.module.css';
import { turnByKey, useResized } from './turning';

export interface StageProps {
  /** What is drawn; keep it as long as it is the same: a new one is built anew. null: not there yet. */
  readonly content: SceneContent | null;
  /** Names of the page's colours. */
  readonly colours: Readonly<Record<keyof SceneColours, string>>;
  readonly palette: number;
  /** Of the buttons above. */
  readonly label: string;
  readonly summary: string;
  readonly caption?: ReactNode;
  readonly button: (label: string, text: string, press: () => void, pressed?: boolean) => ReactNode;
  /** Told of each scene that stands, and of its end with null. */
  readonly onScene?: (scene: Scene | null) => void;
}

const kViews: readonly { name: ViewName; text: string; label: string }[] = [
  { name: 'start', text: marked('Reset'), label: marked('Reset the view') },
  { name: 'superior', text: marked('Superior'), label: marked('Look from superior') },
  { name: 'medial', text: marked('Medial'), label: marked('Look from medial') },
  { name: 'along', text: marked('Along'), label: marked('Look along the tract, as the surgeon does') },
];

/** The scene in `canvas`, anew for each content; one that replaces another of its kind is seen from the same place. */
function useScene(content: SceneContent | null, onScene: StageProps['onScene']) {
  const canvas = useRef<HTMLDivElement>(null);
  const labels = useRef<HTMLDivElement>(null);
  const left = useRef<{ bare?: Looks; planned?: Looks }>({});
  const [scene, setScene] = useState<Scene | null>(null);
  const [failure, setFailure] = useState('');
  useEffect(() => {
    const place = canvas.current,
      holder = labels.current;
    if (!place || !holder || !content) return;
    let gone = false;
    let made: Scene | null = null;
    const kind = content.bare === true ? 'bare' : 'planned';
    const looked = left.current;
    const stands = (now: Scene | null) => {
      setScene(now);
      onScene?.(now);
    };
    const start = async () => {
      if (!canDraw()) {
        setFailure(say('This browser does not support WebGL 2, which the 3-D view needs.'));
        return;
      }
      const { makeScene } = await import('./scene');
      if (gone) return;
      made = makeScene(place, holder, content, looked[kind]);
      place.querySelector('canvas')?.addEventListener('webglcontextlost', () => {
        if (!gone) setFailure(say('The graphics processor lost the 3-D view. Reload the page to draw it again.'));
      });
      stands(made);
    };
    start().catch(() => setFailure(say('The 3-D view could not be drawn.')));
    return () => {
      gone = true;
      if (made) looked[kind] = made.looks();
      made?.destroy();
      stands(null);
    };
  }, [content, onScene]);
  useResized(scene, canvas);
  return { canvas, labels, scene, failure };
}

/** A scene to be turned about, with its views and its bone whole, cut open or away. */
export function Stage({ content, colours, palette, label, summary, caption, button, onScene }: StageProps) {
  const stage = useRef<HTMLDivElement>(null);
  const { canvas, labels, scene, failure } = useScene(content, onScene);
  const [shown, setShown] = useState<'cut' | 'whole' | 'none'>('cut');
  const cut = shown === 'cut' && content?.bare !== true;
  useEffect(() => {
    scene?.colour({
      bone: rgb(colours.bone),
      tract: rgb(colours.tract),
      moment: rgb(colours.moment),
      ghost: rgb(colours.ghost),
    });
  }, [scene, colours, palette]);
  useEffect(() => {
    scene?.bone(shown !== 'none', cut);
  }, [scene, shown, cut]);
  // The wheel belongs to the page until the picture has the focus.
  useEffect(() => {
    const element = stage.current;
    const onWheel = (event: WheelEvent) => {
      if (!event.ctrlKey && !element?.contains(document.activeElement)) event.stopPropagation();
    };
    element?.addEventListener('wheel', onWheel, { capture: true });
    return () => element?.removeEventListener('wheel', onWheel, { capture: true });
  }, []);
  return (
    <figure className={styles.figure}>
      <div className={styles.tools} role="group" aria-label={label}>
        {kViews.map(({ name, text, label: viewLabel }) => (
          <span key={name}>{button(say(viewLabel), say(text), () => scene?.look(name))}</span>
        ))}
        <span className={styles.gap} />
        {content?.bone ? (
          <>
            {button(
              say('Cut open: hide the superior half of the bone'),
              say('Cut open'),
              () => setShown('cut'),
              shown === 'cut',
            )}
            {button(say('Show the whole bone'), say('Whole'), () => setShown('whole'), shown === 'whole')}
            {button(say('Hide the bone'), say('Hide'), () => setShown('none'), shown === 'none')}
          </>
        ) : null}
      </div>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <div
        ref={stage}
        className={styles.stage}
        role="application"
        aria-roledescription={say('3-D picture')}
        aria-label={summary}
        data-part="scene"
        data-ready={scene !== null || undefined}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0}
        onKeyDown={(event) => turnByKey(event, scene, () => scene?.look('start'))}
        onPointerDown={() => stage.current?.focus({ preventScroll: true })}
      >
        <div ref={canvas} className={styles.canvas} hidden={failure !== ''} />
        <div ref={labels} className={styles.labels} aria-hidden="true" hidden={failure !== ''} />
        {failure !== '' ? (
          <p className={styles.failure} role="alert">
            {failure} {say('Everything else on this page is complete without it.')}
          </p>
        ) : null}
        {failure === '' && scene === null ? (
          <p className={styles.failure} role="status">
            {say('Drawing…')}
          </p>
        ) : null}
      </div>
      <figcaption className={styles.caption}>
        {caption}
        <span className={styles.hint}>
          {say('Drag to rotate, Shift-drag to move, click and use the wheel to zoom. Arrow keys rotate.')}
        </span>
      </figcaption>
    </figure>
  );
}
