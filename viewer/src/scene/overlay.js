// What is drawn flat over the scene: the axes of the view from above in metres, the ruler, the ring about a picked point,
// and the cross of axes in the corner.
import { Vector3 } from 'three';
import { element, put } from '../dom.js';
import { shortNumber } from '../format.js';
import { createScale, tickText } from '../plots/scale.js';
import { cssColour } from '../theme.js';

const FONT = '11px system-ui, "DejaVu Sans", sans-serif';
const AXES = [['x', [1, 0, 0]], ['y', [0, 1, 0]], ['z', [0, 0, 1]]];
const COLOURS = ['scene', 'ink', 'rings', 'ruler', 'selected', 'axis-x', 'axis-y', 'axis-z'];
const GIZMO = { size: 64, arm: 21 };

function penOf(canvas, width, height) {
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = FONT;
  return pen;
}

/** A text with a halo, so that it is read on any ground. */
function label(pen, colours, text, x, y) {
  pen.lineWidth = 4;
  pen.strokeStyle = colours.scene;
  pen.strokeText(text, x, y);
  pen.fillStyle = colours.ink;
  pen.fillText(text, x, y);
}

/** @param {{left: number, right: number, low: number, high: number}} seen m */
function drawAxes(pen, colours, seen, width, height) {
  const x = createScale({ low: seen.left, high: seen.right, from: 0, to: width });
  const y = createScale({ low: seen.low, high: seen.high, from: height, to: 0 });
  const columns = x.ticks(Math.max(2, Math.floor(width / 90)));
  const rows = y.ticks(Math.max(2, Math.floor(height / 60)));
  pen.lineWidth = 1;
  pen.strokeStyle = colours.rings;
  pen.globalAlpha = 0.45;
  pen.beginPath();
  for (const tick of columns) {
    const place = Math.round(x.place(tick)) + 0.5;
    pen.moveTo(place, 0);
    pen.lineTo(place, height);
  }
  for (const tick of rows) {
    const place = Math.round(y.place(tick)) + 0.5;
    pen.moveTo(0, place);
    pen.lineTo(width, place);
  }
  pen.stroke();
  pen.globalAlpha = 1;
  pen.textAlign = 'center';
  pen.textBaseline = 'bottom';
  for (const tick of columns) {
    if (x.place(tick) > 50 && x.place(tick) < width - 50) label(pen, colours, tickText(tick, columns), x.place(tick), height - 3);
  }
  pen.textAlign = 'right';
  label(pen, colours, 'x (m)', width - 5, height - 3);
  pen.textAlign = 'left';
  pen.textBaseline = 'middle';
  for (const tick of rows) if (y.place(tick) > 60 && y.place(tick) < height - 24) label(pen, colours, tickText(tick, rows), 4, y.place(tick));
  pen.textBaseline = 'bottom';
  label(pen, colours, 'y (m)', 4, height - 3);
}

/** What a ruler says: the distance, and what of it goes up. @param {number[]} from m @param {number[]} to m */
export function rulerText(from, to) {
  const [dx, dy, dz] = to.map((value, axis) => value - from[axis]);
  const up = Math.abs(dz) > 0.005 ? `, Δz ${shortNumber(dz, 3)} m` : '';
  return `${shortNumber(Math.hypot(dx, dy, dz), 4)} m (Δx ${shortNumber(dx, 3)}, Δy ${shortNumber(dy, 3)}${up ? '' : ' m'}${up})`;
}

function drawRuler(pen, colours, places, text) {
  pen.strokeStyle = pen.fillStyle = colours.ruler;
  pen.lineWidth = 2;
  if (places.length === 2) {
    pen.beginPath();
    pen.moveTo(...places[0]);
    pen.lineTo(...places[1]);
    pen.stroke();
  }
  for (const [x, y] of places) {
    pen.beginPath();
    pen.arc(x, y, 4, 0, 2 * Math.PI);
    pen.fill();
  }
  if (places.length < 2) return;
  pen.textAlign = 'center';
  pen.textBaseline = 'bottom';
  pen.font = `600 ${FONT}`;
  label(pen, colours, text, (places[0][0] + places[1][0]) / 2, (places[0][1] + places[1][1]) / 2 - 6);
  pen.font = FONT;
}

export function createOverlay() {
  const canvas = element('canvas', { class: 'overlay', 'aria-hidden': 'true', hidden: true });
  const gizmo = element('canvas', { class: 'gizmo', 'aria-hidden': 'true', title: 'Axes of the trajectory’s frame' });
  const vector = new Vector3();
  let colours = {};
  let turned = ''; // how the cross of axes was last drawn

  function drawGizmo(camera) {
    const turn = camera.quaternion.toArray().map((value) => value.toFixed(3)).join();
    if (turn === turned) return;
    turned = turn;
    const pen = penOf(gizmo, GIZMO.size, GIZMO.size);
    const middle = GIZMO.size / 2;
    const arms = AXES.map(([name, direction]) => {
      vector.fromArray(direction).transformDirection(camera.matrixWorldInverse);
      return { name, colour: colours[`axis-${name}`], x: middle + GIZMO.arm * vector.x, y: middle - GIZMO.arm * vector.y, toEye: vector.z };
    }).sort((a, b) => a.toEye - b.toEye);
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.font = `600 ${FONT}`;
    for (const { name, colour, x, y } of arms) {
      pen.strokeStyle = pen.fillStyle = colour;
      pen.lineWidth = 2.5;
      pen.beginPath();
      pen.moveTo(middle, middle);
      pen.lineTo(x, y);
      pen.stroke();
      pen.beginPath();
      pen.arc(x, y, 7, 0, 2 * Math.PI);
      pen.fill();
      pen.fillStyle = colours.scene;
      pen.fillText(name, x, y + 0.5);
    }
  }

  return {
    elements: [canvas, gizmo],
    /** Reads the colours of the theme; asking for them at every drawing would cost more than the drawing. */
    setTheme() {
      colours = Object.fromEntries(COLOURS.map((name) => [name, cssColour(`--${name}`)]));
      turned = '';
    },
    /**
     * @param {object} shown
     * @param {ReturnType<ReturnType<typeof import('./camera_rig.js').createCameraRig>['seenFromAbove']>} shown.axes
     * @param {number[][]} shown.ruler none, one or two places of the world, m
     * @param {number[]|null} shown.picked a place of the world
     */
    draw({ axes, ruler, picked }, camera, width, height) {
      camera.updateMatrixWorld();
      drawGizmo(camera);
      put(canvas, 'hidden', !axes && ruler.length === 0 && !picked);
      if (canvas.hidden) return;
      const pen = penOf(canvas, width, height);
      const pixelOf = (place) => {
        vector.fromArray(place).project(camera);
        return Math.abs(vector.z) < 1 ? [(0.5 + 0.5 * vector.x) * width, (0.5 - 0.5 * vector.y) * height] : null;
      };
      if (axes) drawAxes(pen, colours, axes, width, height);
      const at = picked && pixelOf(picked);
      if (at) {
        pen.strokeStyle = colours.selected;
        pen.lineWidth = 2;
        pen.beginPath();
        pen.arc(...at, 7, 0, 2 * Math.PI);
        pen.stroke();
      }
      const ends = ruler.map(pixelOf);
      if (ends.every(Boolean)) drawRuler(pen, colours, ends, ruler.length === 2 ? rulerText(...ruler) : '');
    },
  };
}
