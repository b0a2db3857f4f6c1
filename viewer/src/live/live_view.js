// The scan that came last, where the sensor is, and the way so far: drawn when something new is there, and only then.
import { Color, Scene } from 'three';
import { colouring, quantile } from '../colour/colourings.js';
import { rgb } from '../colour/maps.js';
import { element } from '../dom.js';
import { createCameraRig } from '../scene/camera_rig.js';
import { createRenderer, onNextFrame, poseMatrix } from '../scene/context.js';
import { createLabels } from '../scene/labels.js';
import { createObjects } from '../scene/objects.js';
import { createOverlay } from '../scene/overlay.js';
import { pathSegments } from '../scene/paths.js';
import { createScanPoints } from '../scene/scan_points.js';
import { createSegments } from '../scene/segments.js';
import { createRings, createSensor } from '../scene/surroundings.js';
import { cssColour, groundOf } from '../theme.js';

const POINTS_IN_SOFTWARE = 20000; // where the processor draws, which others need as well
const LONGEST_ARROW = 40; // m
const GROUND_SHARE = 0.05; // of the points are lower than the ground

/** A path as lines, and how it looks. */
function createWay(look, colourName) {
  const lines = createSegments(look);
  let poses = [];
  return {
    object: lines.object,
    put(next) { poses = next; },
    show(origin) {
      const { ends } = pathSegments(poses, poses.length / 7, origin);
      const colour = rgb(cssColour(colourName)).map((value) => value / 255);
      lines.show(ends, Array.from({ length: ends.length / 6 }, () => colour).flat());
    },
  };
}

/** @returns {object|null} null without WebGL */
export function createLiveView(store) {
  const canvas = element('canvas', { class: 'scene', tabindex: 0, role: 'img', 'aria-label': 'Last scan and trajectory so far in 3D' });
  const context = createRenderer(canvas);
  if (!context) return null;
  const { renderer, software } = context;

  const labels = createLabels();
  const overlay = createOverlay();
  const holder = element('div', { class: 'scene-holder' }, canvas, overlay.elements[0], labels.element, overlay.elements[1]);
  const scene = new Scene();
  const points = createScanPoints();
  const objects = createObjects();
  const rings = createRings();
  const sensor = createSensor();
  const path = createWay({ width: 2.4 }, '--series-0');
  const truth = createWay({ width: 6, opacity: 0.35 }, '--ink');
  const atSensor = [objects.object, rings.object, sensor.object];
  for (const object of [points.object, ...atSensor]) object.matrixAutoUpdate = false;
  scene.add(path.object, truth.object, points.object, ...atSensor);
  const rig = createCameraRig(canvas, () => draw());

  let origin = null; // first position that was seen: what is drawn is drawn around it
  let last = { scan: null, objects: [], state: null, pose: null };
  let heading = [0, 0]; // sum of the velocities so far, sensor frame
  let groundHeight = null;
  let ground = 'light';

  const draw = onNextFrame(drawNow);

  function drawNow() {
    const { clientWidth: width, clientHeight: height } = holder;
    if (width === 0 || height === 0) return;
    const camera = rig.camera();
    renderer.render(scene, camera);
    labels.draw([...objects.labels(last.objects, null), ...rings.labels()], objects.object.matrix, camera, width, height);
    overlay.draw({ axes: rig.seenFromAbove(), ruler: [], picked: null }, camera, width, height);
    holder.dataset.draws = Number(holder.dataset.draws ?? 0) + 1;
  }

  function colourPoints() {
    const { colour, limit, limits } = store.state;
    const chosen = colouring(colour);
    const most = limit ?? limits[chosen.id];
    points.colourBy(chosen, chosen.map === 'diverging' ? [-most, most] : [0, most], ground);
  }

  function showObjects() {
    objects.show(last.objects, { ground, byId: store.state.colour === 'kind', selected: null, longest: LONGEST_ARROW });
    const velocity = last.state?.velocity;
    sensor.show(velocity && !velocity.includes(null) ? velocity : null, cssColour('--ink'));
  }

  function showWays() {
    path.show(origin ?? [0, 0, 0]);
    truth.show(origin ?? [0, 0, 0]);
  }

  /** One height for all scans, so that colours and rings do not jump. */
  function findGround(scan) {
    groundHeight = quantile(scan.positions.filter((_, i) => i % 3 === 2), GROUND_SHARE, -1.8);
    points.setGroundHeight(groundHeight);
    rings.show(groundHeight, cssColour('--rings'));
  }

  function moveCamera(pose, state) {
    const [vx, vy] = state?.velocity ?? [];
    if (Number.isFinite(vx) && Number.isFinite(vy)) heading = [heading[0] + vx, heading[1] + vy];
    const { elements } = poseMatrix(pose, origin);
    const ahead = Math.hypot(...heading) > 1 ? Math.atan2(heading[1], heading[0]) : 0;
    rig.moveAnchor({ place: elements.slice(12, 15), yaw: Math.atan2(elements[1], elements[0]) + ahead });
  }

  function applyColours() {
    ground = groundOf(store.state);
    renderer.setClearColor(new Color().setRGB(...cssColour('--scene', true)));
    overlay.setTheme();
    colourPoints();
    showObjects();
    showWays();
    if (groundHeight !== null) rings.show(groundHeight, cssColour('--rings'));
    draw();
  }

  function resize() {
    const { clientWidth: width, clientHeight: height } = holder;
    if (width === 0 || height === 0) return;
    renderer.setSize(width, height, false);
    rig.resize(width, height);
    drawNow(); // at once, or the emptied canvas shows for a moment
  }

  return {
    element: holder,
    start() {
      new ResizeObserver(resize).observe(holder);
      store.watch(['theme', 'systemTheme'], applyColours);
      store.watch(['colour', 'limit', 'limits'], () => {
        colourPoints();
        showObjects();
        draw();
      });
      store.watch(['size'], ({ size }) => {
        points.setSize(size);
        draw();
      });
      points.setShown(true, true, true);
      store.watch(['camera'], ({ camera }) => {
        rig.setMode(camera);
        draw();
      });
      resize();
    },
    /** What is known of the last scan; what did not come with it stays away. */
    show(next) {
      last = next;
      origin ??= next.pose.slice(0, 3);
      if (next.scan) {
        if (groundHeight === null && next.scan.count > 0) findGround(next.scan);
        points.show(next.scan, next.scan.ids, software ? POINTS_IN_SOFTWARE : Infinity);
        points.object.matrix.copy(poseMatrix(next.scanPose, origin));
      }
      for (const object of atSensor) object.matrix.copy(poseMatrix(next.pose, origin));
      showObjects();
      moveCamera(next.pose, next.state);
      draw();
    },
    showPath(poses) {
      path.put(poses);
      showWays();
      draw();
    },
    showTruth(poses) {
      truth.put(poses);
      showWays();
      draw();
    },
    /** Another run begins. */
    clear() {
      origin = null;
      heading = [0, 0];
      groundHeight = null;
      last = { scan: null, objects: [], state: null, pose: null };
      points.show(null, []);
      for (const way of [path, truth]) way.put([]);
      showWays();
      showObjects();
      draw();
    },
    resetCamera() {
      rig.reset();
      draw();
    },
  };
}
