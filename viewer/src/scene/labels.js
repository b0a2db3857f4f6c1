// Texts that stand at places of the scene, as elements over the picture. Where they would cover each other, those that
// matter more stand and the others are hidden.
import { Vector3 } from 'three';
import { element, put } from '../dom.js';

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

const MOST_SIZES = 4000; // of texts, remembered

export function createLabels() {
  const layer = element('div', { class: 'labels', 'aria-hidden': 'true' });
  const pool = []; // {span, transform}
  const sizes = new Map(); // by look and text: asking for one lays the page out
  const world = new Vector3();
  const place = new Vector3();

  /** The sizes of texts; those not known are read all at once. @param {{entry: object, label: object, key: string}[]} seen */
  function measure(seen) {
    const unknown = seen.filter(({ key }) => !sizes.has(key));
    if (unknown.length === 0) return;
    if (sizes.size > MOST_SIZES) sizes.clear();
    for (const { entry } of unknown) put(entry.span, 'hidden', false);
    for (const { entry, key } of unknown) {
      const { offsetWidth: width, offsetHeight: height } = entry.span;
      if (width > 0) sizes.set(key, { width, height });
    }
  }

  return {
    element: layer,
    /**
     * @param {{text: string, place: number[], rank: number, kind?: string}[]} labels
     * @param {import('three').Matrix4} toWorld
     */
    draw(labels, toWorld, camera, width, height) {
      while (pool.length < labels.length) {
        const entry = { span: element('span', { hidden: true }), transform: '' };
        pool.push(entry);
        layer.append(entry.span);
      }
      const seen = [];
      pool.forEach((entry, k) => {
        const label = labels[k];
        if (label) place.copy(world.fromArray(label.place).applyMatrix4(toWorld)).project(camera);
        if (!label || Math.abs(place.z) >= 1 || Math.abs(place.x) >= 1 || Math.abs(place.y) >= 1) {
          put(entry.span, 'hidden', true);
          return;
        }
        const kind = label.kind ?? '';
        put(entry.span, 'textContent', label.text);
        put(entry.span, 'className', kind);
        seen.push({
          entry, key: `${kind} ${label.text}`, x: (0.5 + 0.5 * place.x) * width, y: (0.5 - 0.5 * place.y) * height,
          rank: label.rank, distance: world.distanceTo(camera.position),
        });
      });
      measure(seen);
      const boxes = seen.map(({ key, x, y, rank, distance }) => {
        const size = sizes.get(key) ?? { width: 0, height: 0 };
        // Those at the edge are moved in rather than cut off.
        const left = Math.min(Math.max(0, x - size.width / 2), Math.max(0, width - size.width));
        return { left, top: Math.max(0, y - size.height), ...size, rank, distance };
      });
      placeBoxes(boxes).forEach((stands, k) => {
        const { entry } = seen[k];
        put(entry.span, 'hidden', !stands);
        const transform = `translate(${boxes[k].left}px, ${boxes[k].top}px)`;
        if (stands && transform !== entry.transform) entry.span.style.transform = entry.transform = transform;
      });
    },
  };
}
