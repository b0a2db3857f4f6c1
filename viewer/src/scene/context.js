// What everything in 3D begins with.
import { LinearSRGBColorSpace, Matrix4, Quaternion, Vector3, WebGLRenderer } from 'three';
import { setDrawnByProcessor } from '../processor.js';

const MOST_PIXELS_PER_POINT = 2;

/** Whether lines are drawn by the processor: then every pixel counts. */
function isSoftware(gl) {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software|basic render/i.test(String(info && gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
}

/** A WebGL 2 context on a canvas and whether the processor draws, or null. */
function openContext(canvas) {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return null;
  const software = isSoftware(probe);
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: !software, powerPreference: 'high-performance' });
  return gl && { gl, software };
}

/** @returns {{renderer: WebGLRenderer, software: boolean} | null} null without WebGL 2; software: the processor draws */
export function createRenderer(canvas) {
  const context = openContext(canvas);
  if (!context) return null;
  setDrawnByProcessor(context.software);
  const renderer = new WebGLRenderer({ canvas, context: context.gl });
  renderer.outputColorSpace = LinearSRGBColorSpace; // colours go to the screen as they are
  renderer.setPixelRatio(context.software ? 1 : Math.min(window.devicePixelRatio, MOST_PIXELS_PER_POINT));
  return { renderer, software: context.software };
}

/** What draws once before the screen is shown next, however often it is called until then. */
export function onNextFrame(drawNow) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      drawNow();
    });
  };
}

/** Of a pose [x y z qx qy qz qw], about the origin that is drawn around. */
export const poseMatrix = (pose, origin) => new Matrix4().compose(
  new Vector3(pose[0] - origin[0], pose[1] - origin[1], pose[2] - origin[2]),
  new Quaternion(pose[3], pose[4], pose[5], pose[6]), new Vector3(1, 1, 1));
