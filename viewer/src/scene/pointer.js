// The pointer over the view: what lies under it, clicks that pick or measure.
import { Matrix4, Vector3 } from 'three';
import { boxUnder, pointUnder, rayThrough } from './picking.js';

const REACH = 10; // px, from the pointer to a point
const CLICK = 4; // px; more is a drag
const FARTHEST = 5000; // m, on the ground

/**
 * @param {HTMLCanvasElement} canvas
 * @param {object} store
 * @param {object} scene
 * @param {object} scene.rig @param {object} scene.points @param {object} scene.objects @param {object} scene.rings as the view made them
 * @param {() => {scan: import('../bytes.js').Scan|null, scanObjects: object[], objects: object[]}} scene.shown
 * @param {() => number} scene.groundHeight m, in the sensor frame
 */
export function listenToPointer(canvas, store, { rig, points, objects, rings, shown, groundHeight }) {
  /** A matrix from the frame of something in the scene to clip space. */
  function toClip(part) {
    const camera = rig.camera();
    camera.updateMatrixWorld();
    return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(part.matrix);
  }

  function pixelOf(event) {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top, width: box.width, height: box.height, reach: REACH };
  }

  /** What is known of the point under the pointer, or null. */
  function pickPoint(pixel) {
    const { scan, scanObjects } = shown();
    if (!scan || !points.object.visible) return null;
    const { layers } = store.state;
    const isShown = (i) => layers.has(scan.label[i] === 0 ? 'unused' : scan.label[i] === 1 ? 'still' : 'moving');
    const i = pointUnder(scan.positions, scan.count, toClip(points.object).elements, pixel, isShown);
    return i < 0 ? null : {
      place: Array.from(scan.positions.slice(3 * i, 3 * i + 3)), doppler: scan.doppler[i],
      compensated: scan.compensated[i], residual: scan.residual[i], label: scan.label[i],
      object: scanObjects[scan.label[i] - 3]?.id ?? null,
    };
  }

  /** The point and the object under the pointer: an object by its points, or by its box where no point lies before that. */
  function pick(event) {
    const pixel = pixelOf(event);
    const picked = pickPoint(pixel);
    if (picked && picked.object !== null) return { picked, object: picked.object };
    const ray = rayThrough(toClip(objects.object).invert().elements, pixel);
    const box = objects.boxes.visible ? boxUnder(ray, shown().objects) : null;
    const before = picked && box && new Vector3(...picked.place).applyMatrix4(points.object.matrix)
      .applyMatrix4(objects.object.matrix.clone().invert()).distanceTo(new Vector3(...ray.from)) < box.distance;
    return box && !before ? { picked: null, object: box.object.id } : { picked, object: null };
  }

  /** The place of the world under the pointer: of a point of the scan, else on the ground below the sensor. From above all is level. */
  function placeUnder(event) {
    const pixel = pixelOf(event);
    const picked = pickPoint(pixel);
    const level = rig.seenFromAbove() !== null;
    if (picked) {
      const [x, y, z] = new Vector3(...picked.place).applyMatrix4(points.object.matrix).toArray();
      return [x, y, level ? 0 : z];
    }
    const { from, along } = rayThrough(toClip(rings.object).invert().elements, pixel);
    const distance = (groundHeight() - from[2]) / along[2];
    if (!(distance > 0 && distance < FARTHEST)) return null;
    const [x, y, z] = new Vector3(...from).addScaledVector(new Vector3(...along), distance).applyMatrix4(rings.object.matrix).toArray();
    return [x, y, level ? 0 : z];
  }

  function measure(event) {
    const place = placeUnder(event);
    const { ruler } = store.state;
    if (place) store.set({ ruler: ruler.length === 1 ? [ruler[0], place] : [place] });
  }

  let pressedAt = null;
  canvas.addEventListener('pointerdown', (event) => {
    pressedAt = [event.clientX, event.clientY];
    canvas.classList.add('by-pointer'); // keys that follow draw no frame about it
  });
  canvas.addEventListener('blur', () => canvas.classList.remove('by-pointer'));
  canvas.addEventListener('pointerup', (event) => {
    const moved = pressedAt && Math.hypot(event.clientX - pressedAt[0], event.clientY - pressedAt[1]);
    if (moved === null || moved >= CLICK || event.button !== 0) return;
    if (store.state.measuring) measure(event);
    else store.set(pick(event));
  });
}
