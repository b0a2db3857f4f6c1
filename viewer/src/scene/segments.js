// Straight lines of some pixels' width whose number changes from frame to frame: one buffer, filled again.
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

/** @param {{width: number, opacity?: number}} look width in pixels */
export function createSegments({ width, opacity = 1 }) {
  const material = new LineMaterial({ linewidth: width, transparent: opacity < 1, opacity, vertexColors: true });
  let geometry = null;
  let capacity = 0;
  const lines = new LineSegments2(new LineSegmentsGeometry(), material);
  lines.frustumCulled = false;
  lines.visible = false;

  function reserve(count) {
    if (count <= capacity) return;
    capacity = Math.max(64, Math.ceil(1.5 * count));
    geometry?.dispose();
    geometry = new LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(6 * capacity));
    geometry.setColors(new Float32Array(6 * capacity));
    lines.geometry = geometry;
  }

  return {
    object: lines,
    /** @param {number[]} ends x y z x y z per line @param {number[]} colours r g b per line, 0 to 1 */
    show(ends, colours) {
      const count = ends.length / 6;
      lines.visible = count > 0;
      if (count === 0) return;
      reserve(count);
      const place = geometry.getAttribute('instanceStart').data;
      place.array.set(ends);
      place.needsUpdate = true;
      const colour = geometry.getAttribute('instanceColorStart').data;
      for (let k = 0; k < count; ++k) {
        for (let c = 0; c < 3; ++c) {
          colour.array[6 * k + c] = colours[3 * k + c];
          colour.array[6 * k + 3 + c] = colours[3 * k + c];
        }
      }
      colour.needsUpdate = true;
      geometry.instanceCount = count;
    },
    /** Draws the first `count` lines only. */
    limit(count) {
      if (geometry) geometry.instanceCount = count;
      lines.visible = count > 0 && geometry !== null;
    },
    dispose() {
      geometry?.dispose();
      material.dispose();
    },
  };
}
