// The view: puts the scene together and draws it whenever something changed, and only then.
import { Color, Matrix4, Scene, Vector3 } from 'three';
import { canInflate } from '../bytes.js';
import { colouring, quantile } from '../colour/colourings.js';
import { mapStops } from '../colour/maps.js';
import { element } from '../dom.js';
import { shortNumber } from '../format.js';
import { readMap, readScan } from '../page_data.js';
import { facingOf, headingInSensor, keptScan, objectOf, originOf, poseOf } from '../runs.js';
import { createScanCache } from '../scan_cache.js';
import { groupAt, runAt, runsShown, sameScan } from '../session.js';
import { objectAt } from '../tracks.js';
import { cssColour, groundOf } from '../theme.js';
import { objectAnchor, sensorAnchor } from './anchors.js';
import { boundsOf } from './bounds.js';
import { createCameraRig } from './camera_rig.js';
import { createRenderer, onNextFrame, poseMatrix } from './context.js';
import { createLabels } from './labels.js';
import { createObjects } from './objects.js';
import { createOverlay } from './overlay.js';
import { createPaths } from './paths.js';
import { listenToPointer } from './pointer.js';
import { createPredictedPoints } from './predicted_points.js';
import { pictureOf, save } from './save_picture.js';
import { createScanPoints } from './scan_points.js';
import { createMap, createRings, createSensor } from './surroundings.js';

const KEPT_POINTS = 4e6; // decoded, 29 bytes each
const KEPT_SCANS = [8, 64]; // but not fewer and not more
const READ_AHEAD = 4;
// Where the processor draws: so many points while something moves, all of them once it rests (ms).
const POINTS_IN_MOTION = 8000;
const REST = 180;

/**
 * @returns {{element: HTMLElement, start: () => Promise<void>, resetCamera: () => void, savePicture: () => Promise<void>} | null}
 *   null without WebGL; what `start` promises is the first picture
 */
export function createView(report, store) {
  const canvas = element('canvas', { class: 'scene', tabindex: 0, role: 'img', 'aria-label': 'Scan and trajectory in 3D' });
  const context = createRenderer(canvas);
  if (!context) return null;
  const { renderer, software } = context;

  const several = report.kind !== 'run'; // then all of the trajectories are what one looks at
  const labels = createLabels();
  const overlay = createOverlay();
  const holder = element('div', { class: 'scene-holder' }, canvas, overlay.elements[0], labels.element, overlay.elements[1]);
  const scene = new Scene();
  const points = createScanPoints();
  const predicted = createPredictedPoints();
  const objects = createObjects();
  const paths = createPaths();
  const maps = { map: createMap(), traces: createMap({ moving: true }) };
  const rings = createRings();
  const sensor = createSensor();
  // What is at rest in the sensor frame of the shown scan, and of the current frame.
  const atScan = [points.object, predicted.object];
  const atFrame = [objects.object, rings.object, sensor.object];
  for (const object of [...atScan, ...atFrame]) object.matrixAutoUpdate = false;
  scene.add(paths.estimates, paths.truths, maps.map.object, maps.traces.object, ...atScan, ...atFrame);

  const rig = createCameraRig(canvas, () => {
    showPoints(true);
    draw();
    keepEye();
  });
  const largest = report.runs.reduce((most, run) => (run.scans?.points ?? []).reduce((a, b) => Math.max(a, b), most), 1);
  const cache = createScanCache(readScan, Math.min(KEPT_SCANS[1], Math.max(KEPT_SCANS[0], Math.floor(KEPT_POINTS / largest))));
  let origin = [0, 0, 0];
  const headings = new Map(); // rad, of each run looked at
  let ground = 'light';
  let groundHeight = -1.8;
  let current = { ticket: 0, frame: 0, place: null, scan: null, objects: [], scanObjects: [], run: null };
  let tickets = 0;
  let eyeTimer = 0;
  let restTimer = 0;
  let drawn = null; // the scan in the buffers, and whether it is all of it
  let predictedScan = null; // whose crosses are in the buffers
  let extent = { width: 0, height: 0 }; // px; asking the page for it at every drawing would lay it out
  let draws = 0;
  let firstDrawn = null; // told after the first picture

  const keepEye = () => {
    clearTimeout(eyeTimer);
    eyeTimer = setTimeout(() => store.set({ eye: rig.eye() }), 120);
  };

  const draw = onNextFrame(drawNow);

  function drawNow() {
    const { width, height } = extent;
    if (width === 0 || height === 0 || !current.run) return;
    const camera = rig.camera();
    renderer.render(scene, camera);
    const { layers, picked, object, ruler } = store.state;
    labels.draw([
      ...(layers.has('ids') ? objects.labels(current.objects, object) : []),
      ...(layers.has('rings') ? rings.labels() : []),
    ], objects.object.matrix, camera, width, height);
    overlay.draw({
      axes: rig.seenFromAbove(), ruler,
      picked: picked && new Vector3(...picked.place).applyMatrix4(points.object.matrix).toArray(),
    }, camera, width, height);
    holder.dataset.frame = current.frame;
    holder.dataset.draws = ++draws;
    firstDrawn?.();
  }

  function colourPoints() {
    const { colour, limit, limits } = store.state;
    const chosen = colouring(colour);
    const most = limit ?? limits[chosen.id];
    points.colourBy(chosen, chosen.map === 'diverging' ? [-most, most] : [0, most], ground);
  }

  /** The points of the selected object, in the scan that is shown. */
  function standOut() {
    const place = current.scanObjects.findIndex(({ id }) => id === store.state.object);
    points.standOut(place < 0 ? null : 3 + place);
  }

  function drawObjects() {
    const { colour, layers, object, limits } = store.state;
    // Boxes have the colours of ids where points have them too, else a neutral one: a colour says one thing at a time.
    const byId = colour === 'kind' && !layers.has('predicted');
    objects.show(current.objects, { ground, byId, selected: object, longest: limits.arrow ?? Infinity });
    const run = runAt(report, store.state);
    const velocity = run.frames.ego_velocity.slice(3 * current.frame, 3 * current.frame + 3);
    sensor.show(velocity.every((value) => value !== null) ? velocity : null, cssColour('--ink'));
  }

  /** Puts the points of the current scan into the buffers: fewer while something moves and that would be slow. */
  function showPoints(inMotion) {
    const { scan, scanObjects } = current;
    const most = software && inMotion && scan ? POINTS_IN_MOTION : Infinity;
    const all = !scan || scan.count <= most;
    if (drawn?.scan !== scan || drawn.all !== all) points.show(scan, scanObjects.map(({ id }) => id), most);
    drawn = { scan, all };
    clearTimeout(restTimer);
    if (!all) {
      restTimer = setTimeout(() => {
        showPoints(false);
        draw();
      }, REST);
    }
  }

  /** Where the points of objects go until the next scan; made when it is looked at. */
  function showPredicted() {
    const { scan, scanObjects, run, place } = current;
    if (!store.state.layers.has('predicted') || predictedScan === scan) return;
    predictedScan = scan;
    predicted.show(scan, scanObjects, scan ? run.scans.dt[place] ?? 0 : 0);
  }

  function showScan(run, place, scan) {
    const frame = place === null ? null : run.scans.frames[place];
    const listed = frame === null ? [] : (run.frames.objects[frame] ?? []).map(objectOf);
    current.scanObjects = listed;
    standOut();
    showPoints(true);
    showPredicted();
    if (scan && scan.count > 0) {
      // One height for a whole run, so that colours and rings do not jump.
      if (current.groundOf !== run) {
        groundHeight = quantile(scan.positions.filter((_, i) => i % 3 === 2), 0.05, -1.8);
        points.setGroundHeight(groundHeight);
        rings.show(groundHeight, cssColour('--rings'));
        current.groundOf = run;
      }
    }
    const pose = frame === null ? null : poseOf(run.frames.poses, frame);
    for (const object of atScan) object.matrix.copy(pose ? poseMatrix(pose, origin) : new Matrix4());
  }

  /** By the first kept scan of a run, whichever frame is looked at, so that links keep their meaning. */
  async function headingOf(runIndex) {
    if (!headings.has(runIndex)) {
      const run = report.runs[runIndex];
      const first = run.scans?.frames.length && canInflate() ? await cache.get(runIndex, 0).catch(() => null) : null;
      headings.set(runIndex, headingInSensor(run, first && facingOf(first.positions)));
    }
    return headings.get(runIndex);
  }

  async function showFrame() {
    const ticket = ++tickets;
    const { run: runIndex, frame, playing } = store.state;
    const run = report.runs[runIndex];
    const place = canInflate() ? keptScan(run, frame) : null;
    let scan = null;
    let trouble = run.scans && !canInflate()
      ? 'This browser cannot unpack the scans (it lacks DecompressionStream); everything else works.' : '';
    if (place !== null) {
      try {
        scan = await cache.get(runIndex, place);
      } catch (error) {
        trouble = `The scan of frame ${run.scans.frames[place]} cannot be read: ${error.message}`;
      }
      if (playing) {
        for (let k = 1; k <= READ_AHEAD && place + k < run.scans.frames.length; ++k) cache.get(runIndex, place + k).catch(() => {});
      }
    }
    const heading = await headingOf(runIndex);
    // Something newer may be drawn already; something older may not stand in the way of what follows.
    if (ticket < current.ticket || runIndex !== store.state.run) return;
    const isNewScan = scan !== current.scan || run !== current.run;
    const list = (run.frames.objects[frame] ?? []).map((_, k) => objectAt(run, frame, k));
    // Who tracks nothing states nothing of what was observed.
    const shownObjects = list.map((object) => ({ ...object, observed: object.details?.observed ?? true }));
    current = { ...current, ticket, frame, place, scan, run, objects: shownObjects };
    if (isNewScan) showScan(run, place, scan);
    const pose = poseOf(run.frames.poses, frame);
    const matrix = pose ? poseMatrix(pose, origin) : new Matrix4();
    for (const object of atFrame) object.matrix.copy(matrix);
    drawObjects();
    paths.drive((other) => sameScan(run, frame, other));
    const { chase, object } = store.state;
    const anchor = (chase ? objectAnchor(run, frame, object, origin) : null) ?? (pose && sensorAnchor(matrix, heading));
    if (anchor && !(several && rig.seenFromAbove())) rig.moveAnchor(anchor);
    store.set({ shown: { frame, place, scanFrame: place === null ? null : run.scans.frames[place], trouble } });
    draw();
  }

  function showRuns() {
    const shown = runsShown(report, store.state, ground);
    const group = groupAt(report, store.state);
    const run = runAt(report, store.state);
    origin = originOf(report.runs[group.runs[0]] ?? run);
    const reference = run.truth ? run : shown.map((entry) => entry.run).find((other) => other.truth) ?? null;
    paths.show(shown, reference, cssColour('--ink'), origin);
    rig.setBounds(boundsOf(shown.map((entry) => entry.run), origin));
  }

  async function showMap(name) {
    const map = maps[name];
    const runIndex = store.state.run;
    const wanted = store.state.layers.has(name) && report.runs[runIndex][name] && canInflate();
    if (!wanted || map.object.userData.run === runIndex) return;
    map.object.userData.run = runIndex;
    map.show(null, origin);
    try {
      map.show(await readMap(name, runIndex), origin);
    } catch (error) {
      store.set({ shown: { ...store.state.shown, trouble: `The map cannot be read: ${error.message}` } });
    }
    draw();
  }

  function showLayers() {
    const { layers } = store.state;
    points.setShown(layers.has('unused'), layers.has('still'), layers.has('moving'));
    showPredicted();
    predicted.object.visible = layers.has('predicted');
    objects.boxes.visible = layers.has('boxes');
    objects.arrows.visible = layers.has('arrows');
    paths.estimates.visible = layers.has('path');
    paths.truths.visible = layers.has('truth');
    for (const [name, map] of Object.entries(maps)) {
      map.object.visible = layers.has(name) && map.object.userData.run === store.state.run;
    }
    rings.object.visible = layers.has('rings');
    sensor.object.visible = layers.has('sensor');
    draw();
  }

  function resize() {
    const { clientWidth: width, clientHeight: height } = holder;
    if (width === 0 || height === 0 || (width === extent.width && height === extent.height)) return;
    extent = { width, height };
    renderer.setSize(width, height, false);
    rig.resize(width, height);
    drawNow(); // at once, or the emptied canvas shows for a moment
  }

  listenToPointer(canvas, store, { rig, points, objects, rings, shown: () => current, groundHeight: () => groundHeight });
  canvas.addEventListener('webglcontextrestored', draw);

  const start = () => {
    points.reserve(largest);
    store.watch(['theme', 'systemTheme'], () => {
      ground = groundOf(store.state);
      renderer.setClearColor(new Color().setRGB(...cssColour('--scene', true)));
      predicted.setGround(ground);
      for (const map of Object.values(maps)) map.setGround(ground);
      overlay.setTheme();
      rings.show(groundHeight, cssColour('--rings'));
      drawObjectsIfAny();
      draw();
    });
    store.watch(['colour', 'limit', 'limits', 'theme', 'systemTheme'], () => { colourPoints(); draw(); });
    store.watch(['group', 'run', 'hidden', 'theme', 'systemTheme'], () => { showRuns(); drawObjectsIfAny(); draw(); });
    store.watch(['picked', 'ruler'], draw);
    store.watch(['object'], () => {
      standOut();
      drawObjectsIfAny();
      draw();
    });
    store.watch(['colour', 'layers', 'limits'], () => { drawObjectsIfAny(); draw(); });
    store.watch(['highlight'], ({ highlight }) => {
      paths.highlight(highlight === null ? null : report.runs[highlight]);
      draw();
    });
    store.watch(['measuring'], ({ measuring }) => canvas.classList.toggle('measures', measuring));
    for (const name of Object.keys(maps)) store.watch(['run', 'layers'], () => showMap(name));
    store.watch(['layers', 'run'], showLayers);
    store.watch(['size'], ({ size }) => {
      for (const part of [points, predicted, ...Object.values(maps)]) part.setSize(size);
      draw();
    });
    rig.setMode(store.state.camera, null, several);
    resize();
    let restored = store.state.eye;
    let placed = false;
    store.watch(['run', 'frame'], async () => {
      await showFrame();
      // The eye of a link is relative to the sensor, whose place is known only now.
      if (restored) rig.setMode(store.state.camera, restored);
      else if (!placed && (store.state.camera === 'free' || several)) rig.reset(several);
      restored = null;
      placed = true;
      draw();
    });
    store.watch(['group'], (_, changed) => {
      if (changed && (store.state.camera === 'free' || several) && current.ticket > 0) rig.reset(several);
    });
    let before = chaseOf(store.state);
    store.watch(['chase', 'object'], async (state) => {
      if (chaseOf(state) === before) return;
      before = chaseOf(state);
      await showFrame(); // the anchor is another
      rig.reset(several);
      keepEye();
      draw();
    });
    let mode = store.state.camera;
    store.watch(['camera'], ({ camera }) => {
      if (camera === mode) return;
      mode = camera;
      rig.setMode(camera, null, several);
      keepEye();
      draw();
    });
    new ResizeObserver(resize).observe(holder);
    return new Promise((done) => {
      firstDrawn = () => {
        firstDrawn = null;
        done();
      };
    });
  };

  const chaseOf = ({ chase, object }) => (chase ? object : null);

  function drawObjectsIfAny() {
    if (!current.run) return;
    drawObjects();
    paths.drive((other) => sameScan(current.run, current.frame, other));
  }

  return {
    element: holder,
    start,
    resetCamera() {
      rig.reset(several);
      keepEye();
      draw();
    },
    /** Saves what is seen. */
    async savePicture() {
      const { colour, limit, limits, frame } = store.state;
      const chosen = colouring(colour);
      const most = limit ?? limits[chosen.id];
      const run = runAt(report, store.state);
      const bar = run.scans && chosen.map !== 'categories'
        ? { gradient: mapStops(chosen.map, ground), ends: [chosen.map === 'diverging' ? `−${shortNumber(most)}` : '0', `${shortNumber(most)} ${chosen.unit}`] } : null;
      const { width, height } = extent;
      drawNow(); // a canvas keeps its picture only until the browser has shown it
      const blob = await pictureOf(
        { canvases: [canvas, ...overlay.elements], labels: [...labels.element.children].filter((span) => !span.hidden), width, height },
        { bar, text: `${run.scans ? `${chosen.name} · ` : ''}${report.title} · frame ${frame}` },
        { ground: cssColour('--scene'), ink: cssColour('--ink') });
      save(blob, `${report.title.replace(/[^\w-]+/g, '_').slice(0, 60) || 'report'}-${frame}.png`);
    },
  };
}
