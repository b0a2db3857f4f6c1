// Points of moving objects as measured (discs) and where their velocity takes them until the next scan (crosses): the
// paper's picture of the prediction, told apart by shape as well as by colour.
import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Points, ShaderMaterial } from 'three';
import { markColours, rgb } from '../colour/maps.js';

const vertexShader = `
attribute float predicted;
uniform float size;
varying float isPredicted;
void main() {
  isPredicted = predicted;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  // Crosses stand a little before the points they were made of.
  if (predicted > 0.5) gl_Position.z -= 0.004 * gl_Position.w;
  gl_PointSize = predicted > 0.5 ? 1.6 * size + 3.0 : size + 1.5;
}`;

const fragmentShader = `
uniform vec3 measuredColour;
uniform vec3 predictedColour;
varying float isPredicted;
void main() {
  vec2 away = abs(gl_PointCoord - 0.5);
  if (isPredicted > 0.5 ? min(away.x, away.y) > 0.14 : dot(away, away) > 0.25) discard;
  gl_FragColor = vec4(isPredicted > 0.5 ? predictedColour : measuredColour, 1.0);
}`;

const asColour = (hex) => new Color().setRGB(...rgb(hex).map((value) => value / 255));

/** So many crosses an object: more would be one blot. */
export const MOST_CROSSES = 250;

/**
 * The measured points of objects, then some of them (evenly picked where an object has many) moved by velocity * dt.
 * @param {import('../bytes.js').Scan} scan
 * @param {{velocity: number[]}[]} objects of the scan's frame
 * @param {number} dt s
 * @returns {{measured: number, predicted: number, positions: Float32Array}}
 */
export function predictPoints(scan, objects, dt) {
  const members = objects.map(() => []);
  scan.label.forEach((label, i) => members[label - 3]?.push(i));
  const places = [];
  const put = (i, velocity, seconds) => {
    for (let axis = 0; axis < 3; ++axis) places.push(scan.positions[3 * i + axis] + velocity[axis] * seconds);
  };
  members.forEach((list, k) => list.forEach((i) => put(i, objects[k].velocity, 0)));
  const measured = places.length / 3;
  members.forEach((list, k) => {
    const count = Math.min(list.length, MOST_CROSSES);
    for (let j = 0; j < count; ++j) put(list[Math.floor((j * list.length) / count)], objects[k].velocity, dt);
  });
  return { measured, predicted: places.length / 3 - measured, positions: Float32Array.from(places) };
}

export function createPredictedPoints() {
  let capacity = 0;
  const geometry = new BufferGeometry();
  const uniforms = {
    size: { value: 2 }, measuredColour: { value: new Color() }, predictedColour: { value: new Color() },
  };
  const points = new Points(geometry, new ShaderMaterial({ uniforms, vertexShader, fragmentShader }));
  points.frustumCulled = false;
  points.renderOrder = 1;

  function reserve(count) {
    if (count <= capacity) return;
    capacity = Math.max(1024, Math.ceil(count * 1.5));
    geometry.dispose();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * capacity), 3).setUsage(DynamicDrawUsage));
    geometry.setAttribute('predicted', new BufferAttribute(new Float32Array(capacity), 1).setUsage(DynamicDrawUsage));
  }

  return {
    object: points,
    show(scan, objects, dt) {
      const { measured, predicted, positions } = scan ? predictPoints(scan, objects, dt) : { measured: 0, predicted: 0, positions: [] };
      reserve(measured + predicted);
      if (capacity === 0) return;
      const place = geometry.getAttribute('position');
      place.array.set(positions);
      place.needsUpdate = true;
      const flag = geometry.getAttribute('predicted');
      flag.array.fill(0, 0, measured).fill(1, measured, measured + predicted);
      flag.needsUpdate = true;
      geometry.setDrawRange(0, measured + predicted);
    },
    setSize(size) { uniforms.size.value = size; },
    setGround(ground) {
      uniforms.measuredColour.value = asColour(markColours(ground).measured);
      uniforms.predictedColour.value = asColour(markColours(ground).predicted);
    },
  };
}
