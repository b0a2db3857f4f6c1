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
  gl_PointSize = predicted > 0.5 ? 2.0 * size + 3.0 : size + 1.5;
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

/**
 * The measured points of objects, then the same moved by velocity * dt.
 * @param {import('../bytes.js').Scan} scan
 * @param {{velocity: number[]}[]} objects of the scan's frame
 * @param {number} dt s
 * @returns {{count: number, positions: Float32Array}} 2 * count points
 */
export function predictPoints(scan, objects, dt) {
  const members = [];
  scan.label.forEach((label, i) => { if (label >= 3 && objects[label - 3]) members.push(i); });
  const count = members.length;
  const positions = new Float32Array(6 * count);
  members.forEach((i, k) => {
    const { velocity } = objects[scan.label[i] - 3];
    for (let axis = 0; axis < 3; ++axis) {
      positions[3 * k + axis] = scan.positions[3 * i + axis];
      positions[3 * (count + k) + axis] = scan.positions[3 * i + axis] + velocity[axis] * dt;
    }
  });
  return { count, positions };
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
      const { count, positions } = scan ? predictPoints(scan, objects, dt) : { count: 0, positions: new Float32Array(0) };
      reserve(2 * count);
      if (capacity === 0) return;
      const place = geometry.getAttribute('position');
      place.array.set(positions);
      place.needsUpdate = true;
      const flag = geometry.getAttribute('predicted');
      flag.array.fill(0, 0, count).fill(1, count, 2 * count);
      flag.needsUpdate = true;
      geometry.setDrawRange(0, 2 * count);
    },
    setSize(size) { uniforms.size.value = size; },
    setGround(ground) {
      uniforms.measuredColour.value = asColour(markColours(ground).measured);
      uniforms.predictedColour.value = asColour(markColours(ground).predicted);
    },
  };
}
