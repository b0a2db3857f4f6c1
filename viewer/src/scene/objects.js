// The moving objects of a frame: boxes, arrows as long as the displacement in one second, and what their labels say.
import { Group } from 'three';
import { idColour, idColourIndex, markColours, rgb } from '../colour/maps.js';
import { shortNumber } from '../format.js';
import { createSegments } from './segments.js';
import { arrow, boxEdges } from './shapes.js';

const asShares = (hex) => rgb(hex).map((value) => value / 255);

/** Lines of one width, put together from pieces of one colour. */
function createPieces(width) {
  const lines = createSegments({ width });
  let ends = [];
  let colours = [];
  return {
    object: lines.object,
    clear() { [ends, colours] = [[], []]; },
    add(piece, colour) {
      ends.push(...piece);
      for (let k = 0; k < piece.length / 6; ++k) colours.push(...colour);
    },
    show: () => lines.show(ends, colours),
  };
}

/**
 * @typedef {object} ObjectLook
 * @property {import('../colour/maps.js').Ground} ground
 * @property {boolean} byId objects have the colours of their ids; otherwise those of points say something else
 * @property {number|null} selected id
 * @property {number} longest m, of arrows
 */

export function createObjects() {
  const group = new Group();
  const boxes = createPieces(1.6);
  const chosen = createPieces(3.4);
  const arrows = createPieces(2.6);
  const box = new Group().add(boxes.object, chosen.object);
  const velocity = new Group().add(arrows.object);
  group.add(box, velocity);
  return {
    object: group,
    boxes: box,
    arrows: velocity,
    /** @param {(ReturnType<import('../runs.js').objectOf> & {observed: boolean})[]} objects @param {ObjectLook} look */
    show(objects, { ground, byId, selected, longest }) {
      const marks = markColours(ground);
      for (const pieces of [boxes, chosen, arrows]) pieces.clear();
      for (const object of objects) {
        const isChosen = object.id === selected;
        const colour = asShares(isChosen ? marks.selected : byId ? idColour(idColourIndex(object.id), ground) : marks.box);
        (isChosen ? chosen : boxes).add(boxEdges(object), colour);
        arrows.add(arrow(object.centre, object.velocity, { dashed: !object.observed, most: longest }), colour);
      }
      for (const pieces of [boxes, chosen, arrows]) pieces.show();
    },
    /**
     * Labels over the boxes: texts and places in the sensor frame. The selected object's goes before all others.
     * "~": the speed across the line of sight was not measured.
     */
    labels: (objects, selected) => objects.map((object) => ({
      text: `${object.id} · ${object.observed ? '' : '~'}${shortNumber(Math.hypot(...object.velocity), 2)} m/s`,
      place: [object.centre[0], object.centre[1], object.centre[2] + 0.5 * object.extent[2] + 0.4],
      rank: object.id === selected ? 0 : 1,
      kind: object.id === selected ? 'selected' : '',
    })),
  };
}
