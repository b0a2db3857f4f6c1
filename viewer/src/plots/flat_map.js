// Where WebGL is missing: the ways from above, drawn by the plain canvas.
import { element } from '../dom.js';
import { frameCount, poseOf } from '../runs.js';
import { runAt, runsShown, sameScan } from '../session.js';
import { save } from '../scene/save_picture.js';
import { cssColour, groundOf } from '../theme.js';

const MARGIN = 36;

export function createFlatMap(report, store) {
  const canvas = element('canvas', { class: 'scene', role: 'img', 'aria-label': 'Trajectory from above' });
  const holder = element('div', { class: 'scene-holder flat' }, canvas,
    element('p', { class: 'scene-note', text: 'This browser offers no WebGL 2: scans cannot be shown in 3D. The trajectory is drawn from above, the ground truth as a broad line; everything else works.' }));

  function draw() {
    const { clientWidth: width, clientHeight: height } = holder;
    if (width === 0 || height === 0) return;
    canvas.width = width;
    canvas.height = height;
    const shown = runsShown(report, store.state, groundOf(store.state));
    const front = runAt(report, store.state);
    const ways = shown.map(({ run, colour }) => ({ run, colour, poses: run.frames.poses, wide: false }));
    if (front.truth) ways.unshift({ run: front, colour: cssColour('--muted'), poses: front.truth.poses, wide: true });
    const places = ways.map(({ run, poses }) => Array.from({ length: frameCount(run) }, (_, frame) => poseOf(poses, frame)));
    const all = places.flat().filter(Boolean);
    if (all.length === 0) return;
    let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const [x, y] of all) [left, right, low, high] = [Math.min(left, x), Math.max(right, x), Math.min(low, y), Math.max(high, y)];
    const scale = Math.min((width - 2 * MARGIN) / Math.max(1, right - left), (height - 2 * MARGIN) / Math.max(1, high - low));
    const at = ([x, y]) => [width / 2 + (x - (left + right) / 2) * scale, height / 2 - (y - (low + high) / 2) * scale];
    const pen = canvas.getContext('2d');
    ways.forEach(({ run, colour, wide }, k) => {
      pen.strokeStyle = pen.fillStyle = colour;
      pen.globalAlpha = wide ? 0.4 : 1;
      pen.lineWidth = wide ? 6 : 2;
      pen.beginPath();
      let broken = true;
      for (const pose of places[k]) {
        if (pose) pen[broken ? 'moveTo' : 'lineTo'](...at(pose));
        broken = !pose;
      }
      pen.stroke();
      const here = places[k][sameScan(front, store.state.frame, run)];
      if (here && !wide) {
        pen.beginPath();
        pen.arc(...at(here), 5, 0, 2 * Math.PI);
        pen.fill();
      }
    });
    holder.dataset.frame = store.state.frame;
  }

  return {
    element: holder,
    start() {
      store.watch(['frame', 'run', 'group', 'hidden', 'theme', 'systemTheme'], draw);
      new ResizeObserver(draw).observe(holder);
      return Promise.resolve();
    },
    resetCamera() {},
    savePicture() { canvas.toBlob((blob) => save(blob, 'trajectory.png')); },
  };
}
