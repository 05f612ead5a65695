/** The tract in three dimensions. A chunk of its own: loaded when it is first shown. */
import { makeBone } from './bone';
import { makeLabels } from './labels';
import { makeGhost, makeMoment, makePath } from './path';
import { makeBreach, makeTract } from './tract';
import {
  kPerMetre,
  scaled,
  sum,
  type SceneBone,
  type SceneBreach,
  type SceneColours,
  type ScenePath,
  type SceneTract,
  type Vec3,
  type ViewName,
} from './types';
import { dispose, fit, makeWindow, paced } from './window';

export interface Scene {
  look(view: ViewName): void;
  /** Turns the camera by degrees about the tract. */
  turn(azimuth: number, elevation: number): void;
  zoom(factor: number): void;
  bone(visible: boolean, cut: boolean): void;
  colour(colours: SceneColours): void;
  moment(t_s: number | null): void;
  /** The same of the other trial. */
  ghost(t_s: number | null): void;
  resize(): void;
  /** Where it is looked at from, for a scene that takes this one's place. */
  looks(): Looks;
  destroy(): void;
}

/** A camera, in the scene's millimetres. */
export interface Looks {
  readonly from: Vec3;
  readonly at: Vec3;
  readonly up: Vec3;
}

export interface SceneContent {
  readonly tract: SceneTract;
  readonly path: ScenePath;
  readonly bone: SceneBone | null;
  /** Force at the top of the colour scale. */
  readonly most_N: number;
  readonly breach?: SceneBreach | null;
  /** Another trial on the same case, drawn behind. */
  readonly ghost?: ScenePath | null;
  /** No channel is drawn, nor named: the tract only says where to look. */
  readonly bare?: boolean;
}

/** Where the camera stands (from the middle of the tract) and what is up. */
function stand(view: ViewName, { axis, medial, superior }: SceneTract): { from: Vec3; up: Vec3 } {
  switch (view) {
    case 'medial':
      return { from: medial, up: superior };
    case 'superior':
      return { from: superior, up: axis };
    case 'along':
      return { from: scaled(axis, -1), up: superior };
    case 'start':
      return { from: sum(scaled(superior, 0.8), scaled(axis, -0.42), scaled(medial, 0.42)), up: superior };
  }
}

/** Throws where the browser cannot draw; the caller says so on the page. Without `looks` it is looked at from where it starts. */
export function makeScene(
  container: HTMLElement,
  labelHolder: HTMLElement,
  content: SceneContent,
  looks?: Looks,
): Scene {
  const drawing = makeWindow(container);
  const { renderer } = drawing;
  const { tract } = content;
  const tube = makeTract(tract);
  const ball = makeMoment(content.path);
  const bone = content.bone ? makeBone(content.bone, tract) : null;
  const other =
    content.ghost && content.ghost.tip_m.length > 1
      ? { way: makeGhost(content.ghost), ball: makeMoment(content.ghost) }
      : null;
  if (other) {
    renderer.addActor(other.way);
    renderer.addActor(other.ball.actor);
  }
  const hole = content.breach ? makeBreach(content.breach, tract.radius_m) : null;
  if (!content.bare) renderer.addActor(tube);
  if (hole) renderer.addActor(hole);
  if (content.path.tip_m.length > 1) renderer.addActor(makePath(content.path, content.most_N));
  renderer.addActor(ball.actor);
  for (const actor of bone?.actors ?? []) renderer.addActor(actor);

  const placeLabels = content.bare ? () => undefined : makeLabels(labelHolder, tract, renderer);
  const camera = renderer.getActiveCamera();
  camera.setParallelProjection(false);
  const render = paced(container, drawing);
  const watching = camera.onModified(placeLabels);

  const stands = ({ from, at, up }: Looks) => {
    camera.setFocalPoint(...at);
    camera.setPosition(...from);
    camera.setViewUp(...up);
    renderer.resetCameraClippingRange();
    render();
  };
  const look = (name: ViewName) => {
    const middle = sum(scaled(tract.entry_m), scaled(tract.axis, (tract.length_m * kPerMetre) / 2));
    const { from, up } = stand(name, tract);
    const size = Math.sqrt(from[0] ** 2 + from[1] ** 2 + from[2] ** 2);
    const distance = tract.length_m * kPerMetre * 2.2;
    stands({ from: sum(middle, scaled(from, distance / size)), at: middle, up });
  };

  const scene: Scene = {
    look,
    looks: () => ({ from: camera.getPosition(), at: camera.getFocalPoint(), up: camera.getViewUp() }),
    turn(azimuth, elevation) {
      camera.azimuth(azimuth);
      camera.elevation(elevation);
      camera.orthogonalizeViewUp();
      renderer.resetCameraClippingRange();
      render();
    },
    zoom(factor) {
      camera.dolly(factor);
      renderer.resetCameraClippingRange();
      render();
    },
    bone(visible, cut) {
      bone?.show(visible, cut);
      render();
    },
    colour(colours) {
      bone?.colour(colours.bone);
      tube.getProperty().setColor(...colours.tract);
      ball.actor.getProperty().setColor(...colours.moment);
      for (const actor of other ? [other.way, other.ball.actor] : [])
        actor.getProperty().setColor(...(colours.ghost ?? colours.tract));
      hole?.getProperty().setColor(...colours.moment);
      render();
    },
    moment(t_s) {
      if (ball.put(t_s)) render();
    },
    ghost(t_s) {
      if (other?.ball.put(t_s)) render();
    },
    resize() {
      fit(container, drawing);
      placeLabels();
      render();
    },
    destroy() {
      watching.unsubscribe();
      labelHolder.replaceChildren();
      dispose(container, drawing);
    },
  };
  scene.resize();
  if (looks) stands(looks);
  else look('start');
  return scene;
}
