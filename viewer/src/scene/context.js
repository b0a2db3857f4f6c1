// What everything in 3D begins with.
import { Matrix4, Quaternion, Vector3 } from 'three';

/** Whether lines are drawn by the processor: then every pixel counts. */
function isSoftware(gl) {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software|basic render/i.test(String(info && gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
}

/** A WebGL 2 context on a canvas and whether the processor draws, or null. */
export function openContext(canvas) {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return null;
  const software = isSoftware(probe);
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: !software, powerPreference: 'high-performance' });
  return gl && { gl, software };
}

/** Of a pose [x y z qx qy qz qw], about the origin that is drawn around. */
export const poseMatrix = (pose, origin) => new Matrix4().compose(
  new Vector3(pose[0] - origin[0], pose[1] - origin[1], pose[2] - origin[2]),
  new Quaternion(pose[3], pose[4], pose[5], pose[6]), new Vector3(1, 1, 1));
