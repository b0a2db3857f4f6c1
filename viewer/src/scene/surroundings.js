// What stands: the static map, circles of equal distance about the sensor, and the sensor itself.
import { BufferAttribute, BufferGeometry, Color, Group, Points, ShaderMaterial, Vector2 } from 'three';
import { markColours, rgb } from '../colour/maps.js';
import { createSegments } from './segments.js';
import { arrow, circle } from './shapes.js';

export const RING_RADII = [10, 20, 40, 80];

const mapVertexShader = `
uniform vec2 heights;
uniform vec3 low;
uniform vec3 high;
uniform float size;
varying vec3 colour;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = size;
  colour = mix(low, high, clamp((position.z - heights.x) / (heights.y - heights.x), 0.0, 1.0));
}`;
const mapFragmentShader = 'varying vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }';

const asColour = (bytes) => new Color().setRGB(...bytes.map((value) => value / 255));

/** Points of the whole drive. Static ones are pale, brighter or darker with height; those that move have their colour of the legend. */
export function createMap({ moving = false } = {}) {
  const uniforms = {
    heights: { value: new Vector2(0, 1) }, low: { value: new Color() }, high: { value: new Color() }, size: { value: 1.5 },
  };
  const points = new Points(new BufferGeometry(),
    new ShaderMaterial({ uniforms, vertexShader: mapVertexShader, fragmentShader: mapFragmentShader }));
  points.frustumCulled = false;
  return {
    object: points,
    show(map, origin) {
      points.geometry.dispose();
      points.geometry = new BufferGeometry();
      if (!map || map.count === 0) return;
      points.geometry.setAttribute('position', new BufferAttribute(map.positions, 3));
      points.position.set(...map.origin.map((value, axis) => value - origin[axis]));
      const heights = map.positions.filter((_, i) => i % 3 === 2).sort();
      const low = heights[Math.floor(0.05 * heights.length)];
      uniforms.heights.value.set(low, Math.max(low + 1, heights[Math.floor(0.95 * heights.length)]));
    },
    setGround(ground) {
      if (moving) {
        uniforms.low.value = uniforms.high.value = asColour(rgb(markColours(ground).moving));
        return;
      }
      uniforms.low.value = asColour(ground === 'dark' ? [38, 48, 64] : [205, 210, 218]);
      uniforms.high.value = asColour(ground === 'dark' ? [98, 118, 146] : [140, 152, 170]);
    },
    setSize(size) { uniforms.size.value = Math.max(1, 0.7 * size); },
  };
}

/** Circles on the ground around the sensor, with their labels. */
export function createRings() {
  const lines = createSegments({ width: 1, opacity: 0.55 });
  const group = new Group().add(lines.object);
  let height = 0;
  return {
    object: group,
    show(groundHeight, colour) {
      height = groundHeight;
      const ends = RING_RADII.flatMap((radius) => circle(radius, height));
      const grey = rgb(colour).map((value) => value / 255);
      lines.show(ends, ends.filter((_, k) => k % 6 === 0).flatMap(() => grey));
    },
    labels: () => RING_RADII.map((radius) => ({ text: `${radius} m`, place: [0, -radius, height], rank: 2, kind: 'ring' })),
  };
}

/** The sensor's axes (x red, y green, z blue, each with its length) and its own velocity. */
export function createSensor() {
  const lines = createSegments({ width: 3 });
  return {
    object: new Group().add(lines.object),
    show(velocity, colour) {
      const axes = [0, 0, 0, 1.4, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1];
      const shaft = velocity ? arrow([0, 0, 0], velocity) : [];
      const ink = rgb(colour).map((value) => value / 255);
      lines.show([...axes, ...shaft],
        [0.9, 0.25, 0.2, 0.2, 0.7, 0.35, 0.25, 0.45, 0.95, ...Array.from({ length: shaft.length / 6 }, () => ink).flat()]);
    },
  };
}

