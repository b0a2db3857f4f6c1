// The moving objects of a frame: boxes, arrows as long as the way in one second, and what their labels say.
import { Group } from 'three';
import { categoryColour, rgb } from '../colour/maps.js';
import { shortNumber } from '../format.js';
import { objectColourIndex } from './scan_points.js';
import { createSegments } from './segments.js';
import { arrow, boxEdges } from './shapes.js';

const repeated = (colour, ends) => Array.from({ length: ends.length / 6 }, () => colour).flat();

export function createObjects() {
  const group = new Group();
  const boxes = createSegments({ width: 1.6 });
  const arrows = createSegments({ width: 2.6 });
  const box = new Group().add(boxes.object);
  const velocity = new Group().add(arrows.object);
  group.add(box, velocity);
  return {
    object: group,
    boxes: box,
    arrows: velocity,
    /** @param {ReturnType<import('../runs.js').objectOf>[]} objects @param {import('../colour/maps.js').Ground} ground */
    show(objects, ground) {
      const edges = [];
      const edgeColours = [];
      const shafts = [];
      const shaftColours = [];
      for (const object of objects) {
        const colour = rgb(categoryColour(objectColourIndex(object.id), ground)).map((value) => value / 255);
        const frame = boxEdges(object);
        edges.push(...frame);
        edgeColours.push(...repeated(colour, frame));
        const shaft = arrow(object.centre, object.velocity);
        shafts.push(...shaft);
        shaftColours.push(...repeated(colour, shaft));
      }
      boxes.show(edges, edgeColours);
      arrows.show(shafts, shaftColours);
    },
    /** Labels over the boxes: texts and places in the sensor frame. The picked object's goes before all others. */
    labels: (objects, pickedId) => objects.map((object) => ({
      text: `${object.id} · ${shortNumber(Math.hypot(...object.velocity), 2)} m/s`,
      place: [object.centre[0], object.centre[1], object.centre[2] + 0.5 * object.extent[2] + 0.4],
      rank: object.id === pickedId ? 0 : 1,
    })),
  };
}
