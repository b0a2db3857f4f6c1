// Texts that stand at places of the scene, as elements over the picture.
import { Vector3 } from 'three';
import { element } from '../dom.js';

export function createLabels() {
  const layer = element('div', { class: 'labels', 'aria-hidden': 'true' });
  const pool = [];
  const place = new Vector3();
  return {
    element: layer,
    /**
     * @param {{text: string, place: number[], kind?: string}[]} labels
     * @param {import('three').Matrix4} toWorld
     */
    draw(labels, toWorld, camera, width, height) {
      while (pool.length < labels.length) {
        pool.push(element('span'));
        layer.append(pool.at(-1));
      }
      pool.forEach((span, k) => {
        const label = labels[k];
        if (label) place.fromArray(label.place).applyMatrix4(toWorld).project(camera);
        const seen = label && Math.abs(place.z) < 1 && Math.abs(place.x) < 1.05 && Math.abs(place.y) < 1.05;
        span.hidden = !seen;
        if (!seen) return;
        if (span.textContent !== label.text) span.textContent = label.text;
        span.className = label.kind ?? '';
        span.style.transform = `translate(${(0.5 + 0.5 * place.x) * width}px, ${(0.5 - 0.5 * place.y) * height}px) translate(-50%, -100%)`;
      });
    },
  };
}
