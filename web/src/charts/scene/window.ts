/** A renderer in a part of the page, turned by the pointer. */
import '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';
import vtkInteractorStyleTrackballCamera from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor';
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow';

export function makeWindow(container: HTMLElement) {
  const window = vtkRenderWindow.newInstance();
  const renderer = vtkRenderer.newInstance();
  renderer.setBackground([0, 0, 0, 0]); // clear: the page's own colour shows
  window.addRenderer(renderer);
  const view = vtkOpenGLRenderWindow.newInstance();
  view.setContainer(container);
  window.addView(view);
  const interactor = vtkRenderWindowInteractor.newInstance();
  interactor.setView(view);
  interactor.initialize();
  interactor.bindEvents(container);
  interactor.setInteractorStyle(vtkInteractorStyleTrackballCamera.newInstance());
  return { window, renderer, view, interactor };
}

type Drawing = ReturnType<typeof makeWindow>;

/** Draws at the next frame, once, however often it is requested. */
export function paced(container: HTMLElement, drawing: Drawing): () => void {
  let requested = false;
  return () => {
    if (requested) return;
    requested = true;
    requestAnimationFrame(() => {
      requested = false;
      if (container.isConnected && !drawing.window.isDeleted()) drawing.window.render();
    });
  };
}

export function fit(container: HTMLElement, drawing: Drawing): void {
  const { width, height } = container.getBoundingClientRect();
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  drawing.view.setSize(Math.max(1, Math.floor(width * ratio)), Math.max(1, Math.floor(height * ratio)));
}

export function dispose(container: HTMLElement, drawing: Drawing): void {
  drawing.interactor.unbindEvents();
  // A browser holds few contexts: this one is given back now, not when memory is next swept.
  const context = container.querySelector('canvas')?.getContext('webgl2');
  drawing.window.removeView(drawing.view);
  drawing.view.delete();
  drawing.window.delete();
  context?.getExtension('WEBGL_lose_context')?.loseContext();
}
