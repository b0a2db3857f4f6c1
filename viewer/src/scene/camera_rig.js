// The camera: behind the sensor, free, or from above. What a link keeps is the place of eye and target relative to what
// the camera goes with.
//
// From above there is no perspective: lengths can be read off. The controls move one camera all the same; how far it is
// from its target is how much is seen.
import { OrthographicCamera, PerspectiveCamera } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

export const CAMERA_MODES = ['follow', 'free', 'top'];

const BEHIND = [-22, 0, 11, 10, 0, -1];
const ABOVE = [0, -0.02, 95, 0, 0, 0];
const SKY = 1000; // m over the target, of the camera from above

const turned = ([x, y, z], yaw) => [Math.cos(yaw) * x - Math.sin(yaw) * y, Math.sin(yaw) * x + Math.cos(yaw) * y, z];

/** A place given relative to the anchor, in the world. `follow` turns with it, `top` goes with it, `free` stays. */
export function fromAnchor(mode, anchor, place) {
  if (mode === 'free') return place;
  const moved = mode === 'follow' ? turned(place, anchor.yaw) : place;
  return moved.map((value, axis) => value + anchor.place[axis]);
}

/** The other way round. */
export function toAnchor(mode, anchor, place) {
  if (mode === 'free') return place;
  const moved = place.map((value, axis) => value - anchor.place[axis]);
  return mode === 'follow' ? turned(moved, -anchor.yaw) : moved;
}

/** @param {HTMLElement} canvas @param {() => void} changed called whenever the camera moved by hand */
export function createCameraRig(canvas, changed) {
  const camera = new PerspectiveCamera(55, 1, 0.3, 5000);
  camera.up.set(0, 0, 1);
  const flat = new OrthographicCamera(-1, 1, 1, -1, 0.3, 2 * SKY);
  flat.up.set(0, 1, 0);
  const controls = new OrbitControls(camera, canvas);
  controls.minDistance = 1;
  controls.maxDistance = 4000;
  controls.zoomSpeed = 1.4;
  controls.maxPolarAngle = Math.PI * 0.98;
  let mode = 'follow';
  let anchor = { place: [0, 0, 0], yaw: 0 };
  let bounds = { centre: [0, 0, 0], radius: 30 };
  let silent = false;
  controls.addEventListener('change', () => { if (!silent) changed(); });

  const relative = () => [
    ...toAnchor(mode, anchor, camera.position.toArray()), ...toAnchor(mode, anchor, controls.target.toArray()),
  ];
  function place(eye) {
    camera.position.set(...fromAnchor(mode, anchor, eye.slice(0, 3)));
    controls.target.set(...fromAnchor(mode, anchor, eye.slice(3)));
    silent = true;
    controls.update();
    silent = false;
  }
  /** The camera from above, over the target of the other. */
  function fromAbove() {
    const half = camera.position.distanceTo(controls.target) * Math.tan((camera.fov * Math.PI) / 360);
    const { x, y, z } = controls.target;
    Object.assign(flat, { left: -half * camera.aspect, right: half * camera.aspect, top: half, bottom: -half });
    flat.position.set(x, y, z + SKY);
    flat.lookAt(x, y, z);
    flat.updateProjectionMatrix();
    flat.updateMatrixWorld();
    return flat;
  }
  /** All of the trajectory, seen from the south and above. */
  function overview() {
    const away = Math.max(20, bounds.radius * 1.15 / Math.tan((camera.fov * Math.PI) / 360) / Math.min(1, camera.aspect));
    const [x, y, z] = bounds.centre;
    return [x, y - 0.45 * away, z + 0.9 * away, x, y, z];
  }
  return {
    /** What to draw with. */
    camera: () => (mode === 'top' ? fromAbove() : camera),
    /** What is seen from above: m in the world, y up; null with perspective. */
    seenFromAbove() {
      if (mode !== 'top') return null;
      const { left, right, top, bottom, position: { x, y } } = fromAbove();
      return { left: x + left, right: x + right, low: y + bottom, high: y + top };
    },
    /** Eye and target, six numbers, for `setMode` and links. */
    eye: relative,
    setMode(newMode, eye, all = false) {
      const before = { eye: camera.position.toArray(), target: controls.target.toArray() };
      const had = mode;
      mode = CAMERA_MODES.includes(newMode) ? newMode : 'follow';
      controls.enableRotate = mode !== 'top';
      controls.screenSpacePanning = mode === 'top';
      if (eye) place(eye);
      else if (mode === 'free' && had !== 'free') place([...before.eye, ...before.target]);
      else this.reset(all);
    },
    /** @param {boolean} [all] from above: all of the trajectory */
    reset(all = false) {
      const { centre: [x, y, z], radius } = bounds;
      const away = radius * 1.25 / Math.tan((camera.fov * Math.PI) / 360) / Math.min(1, camera.aspect);
      const above = all ? [...toAnchor('top', anchor, [x, y - 0.0002 * away, z + away]), ...toAnchor('top', anchor, [x, y, z])] : ABOVE;
      place(mode === 'follow' ? BEHIND : mode === 'top' ? above : overview());
    },
    /** The sensor went on: so does the camera. */
    moveAnchor(next) {
      const eye = relative();
      anchor = next;
      place(eye);
    },
    setBounds(next) { bounds = next; },
    resize(width, height) {
      camera.aspect = width / height;
      // A tall view sees as much to the sides as a square one.
      camera.fov = width < height ? (360 / Math.PI) * Math.atan(Math.tan((27.5 * Math.PI) / 180) * Math.min(1.6, height / width)) : 55;
      camera.updateProjectionMatrix();
    },
  };
}
