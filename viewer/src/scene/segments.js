// Straight lines of some pixels' width: one quad each, put up by the shader. Their number may change from frame to frame;
// the buffers are made once and filled again. Four vertices a line rather than instances: where the processor draws,
// every instance costs as much as a drawing of its own.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, ShaderMaterial, Vector2 } from 'three';

const vertexShader = `
attribute vec2 corner; // along the line 0 or 1, across -1 or 1
attribute vec3 start;
attribute vec3 end;
attribute vec3 tint;
attribute float until;
uniform vec2 resolution;
uniform float width;
uniform float now;
uniform float opacity;
uniform float pale;
varying vec4 colour;
const float NEAREST = -0.31; // just beyond the near plane of the cameras

void main() {
  vec4 a = modelViewMatrix * vec4(start, 1.0);
  vec4 b = modelViewMatrix * vec4(end, 1.0);
  if (a.z > NEAREST && b.z > NEAREST) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // behind the camera
    return;
  }
  if (a.z > NEAREST) a = mix(a, b, (NEAREST - a.z) / (b.z - a.z));
  if (b.z > NEAREST) b = mix(b, a, (NEAREST - b.z) / (a.z - b.z));
  vec4 from = projectionMatrix * a;
  vec4 to = projectionMatrix * b;
  vec2 way = (to.xy / to.w - from.xy / from.w) * resolution;
  float size = length(way);
  vec2 across = size > 0.0 ? vec2(-way.y, way.x) / size : vec2(0.0, 1.0);
  gl_Position = corner.x < 0.5 ? from : to;
  gl_Position.xy += corner.y * across * width / resolution * gl_Position.w;
  colour = vec4(tint, until <= now ? opacity : pale);
}`;

const fragmentShader = 'varying vec4 colour; void main() { gl_FragColor = colour; }';

const CORNERS = [[0, -1], [1, -1], [0, 1], [1, 1]];
const TRIANGLES = [0, 1, 2, 2, 1, 3];

/** @param {{width: number, opacity?: number, pale?: number}} look width in pixels; pale: of lines that end after `now` */
export function createSegments({ width, opacity = 1, pale = opacity }) {
  const uniforms = {
    resolution: { value: new Vector2(1, 1) }, width: { value: width }, now: { value: 1e9 },
    opacity: { value: opacity }, pale: { value: pale },
  };
  const transparent = Math.min(opacity, pale) < 1;
  const material = new ShaderMaterial({ uniforms, vertexShader, fragmentShader, transparent, depthWrite: !transparent });
  const geometry = new BufferGeometry();
  const lines = new Mesh(geometry, material);
  lines.frustumCulled = false;
  lines.visible = false;
  lines.onBeforeRender = (renderer) => {
    renderer.getDrawingBufferSize(uniforms.resolution.value);
    uniforms.width.value = width * renderer.getPixelRatio();
  };
  let capacity = 0;

  function reserve(count) {
    if (count <= capacity) return;
    capacity = Math.max(64, Math.ceil(1.5 * count));
    geometry.dispose();
    const index = new Uint32Array(6 * capacity);
    const corners = new Float32Array(8 * capacity);
    for (let k = 0; k < capacity; ++k) {
      index.set(TRIANGLES.map((corner) => 4 * k + corner), 6 * k);
      corners.set(CORNERS.flat(), 8 * k);
    }
    geometry.setIndex(new BufferAttribute(index, 1));
    geometry.setAttribute('corner', new BufferAttribute(corners, 2));
    for (const [name, size] of [['start', 3], ['end', 3], ['tint', 3], ['until', 1]]) {
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(4 * size * capacity), size).setUsage(DynamicDrawUsage));
    }
  }

  return {
    object: lines,
    /**
     * @param {number[]} ends x y z x y z per line @param {number[]} colours r g b per line, 0 to 1
     * @param {number[]} [until] per line what `setNow` is compared with
     */
    show(ends, colours, until = []) {
      const count = ends.length / 6;
      lines.visible = count > 0;
      if (count === 0) return;
      reserve(count);
      const { start, end, tint, until: limit } = geometry.attributes;
      for (let vertex = 0; vertex < 4 * count; ++vertex) {
        const k = vertex >> 2;
        for (let axis = 0; axis < 3; ++axis) {
          start.array[3 * vertex + axis] = ends[6 * k + axis];
          end.array[3 * vertex + axis] = ends[6 * k + 3 + axis];
          tint.array[3 * vertex + axis] = colours[3 * k + axis];
        }
        limit.array[vertex] = until[k] ?? 0;
      }
      for (const attribute of [start, end, tint, limit]) {
        attribute.clearUpdateRanges();
        attribute.addUpdateRange(0, 4 * count * attribute.itemSize);
        attribute.needsUpdate = true;
      }
      geometry.setDrawRange(0, 6 * count);
    },
    setNow(now) { uniforms.now.value = now; },
    /** Paler than their look says. @param {number} share */
    fade(share) { [uniforms.opacity.value, uniforms.pale.value] = [share * opacity, share * pale]; },
    dispose() {
      geometry.dispose();
      material.dispose();
    },
  };
}
