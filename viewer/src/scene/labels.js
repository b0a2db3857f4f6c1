// Texts that stand at places of the scene, as elements over the picture. Where they would cover each other, those that
// matter more stand and the others are hidden.
import { Vector3 } from 'three';
import { element } from '../dom.js';

const GAP = 2; // pixels between texts

/**
 * Which of the texts stand: by rank (lower first), then the nearest to the camera first; one that would cover a text
 * that stands already is left out.
 * @param {{left: number, top: number, width: number, height: number, rank: number, distance: number}[]} boxes pixels
 * @returns {boolean[]} for each box
 */
export function placeBoxes(boxes) {
  const standing = [];
  const stands = boxes.map(() => false);
  const order = boxes.map((_, k) => k).sort((a, b) => boxes[a].rank - boxes[b].rank || boxes[a].distance - boxes[b].distance || a - b);
  for (const k of order) {
    const { left, top, width, height } = boxes[k];
    stands[k] = standing.every((other) => left >= other.left + other.width + GAP || other.left >= left + width + GAP
      || top >= other.top + other.height + GAP || other.top >= top + height + GAP);
    if (stands[k]) standing.push(boxes[k]);
  }
  return stands;
}

export function createLabels() {
  const layer = element('div', { class: 'labels', 'aria-hidden': 'true' });
  const pool = [];
  const world = new Vector3();
  const place = new Vector3();
  return {
    element: layer,
    /**
     * @param {{text: string, place: number[], rank: number, kind?: string}[]} labels
     * @param {import('three').Matrix4} toWorld
     */
    draw(labels, toWorld, camera, width, height) {
      while (pool.length < labels.length) {
        pool.push(element('span'));
        layer.append(pool.at(-1));
      }
      const seen = [];
      pool.forEach((span, k) => {
        const label = labels[k];
        if (label) place.copy(world.fromArray(label.place).applyMatrix4(toWorld)).project(camera);
        span.hidden = !label || Math.abs(place.z) >= 1 || Math.abs(place.x) >= 1 || Math.abs(place.y) >= 1;
        if (span.hidden) return;
        if (span.textContent !== label.text) span.textContent = label.text;
        span.className = label.kind ?? '';
        seen.push({
          span, x: (0.5 + 0.5 * place.x) * width, y: (0.5 - 0.5 * place.y) * height,
          rank: label.rank, distance: world.distanceTo(camera.position),
        });
      });
      // All sizes are read before anything is moved, so that the page is laid out once.
      const boxes = seen.map(({ span, x, y, rank, distance }) => {
        const { offsetWidth, offsetHeight } = span;
        // Those at the edge are moved in rather than cut off.
        const left = Math.min(Math.max(0, x - offsetWidth / 2), Math.max(0, width - offsetWidth));
        return { left, top: Math.max(0, y - offsetHeight), width: offsetWidth, height: offsetHeight, rank, distance };
      });
      placeBoxes(boxes).forEach((stands, k) => {
        seen[k].span.hidden = !stands;
        if (stands) seen[k].span.style.transform = `translate(${boxes[k].left}px, ${boxes[k].top}px)`;
      });
    },
  };
}
