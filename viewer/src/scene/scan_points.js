// The points of one scan: buffers that are made once and filled again, colours looked up in the shader, so that another
// colouring or limit touches no point.
import {
  BufferAttribute, BufferGeometry, ClampToEdgeWrapping, Color, DataTexture, DynamicDrawUsage, LinearFilter, NearestFilter,
  Points, RGBAFormat, ShaderMaterial, Vector2,
} from 'three';
import { UNKNOWN } from '../bytes.js';
import { ID_COLOURS, idColour, idColourIndex, lookupTable, markColours, rgb } from '../colour/maps.js';

const vertexShader = `
attribute float doppler;
attribute float compensated;
attribute float residual;
attribute float category;
uniform int source;
uniform vec2 range;
uniform float ground;
uniform float size;
uniform float pixelsPerUnit;
uniform vec3 shown; // not used, static, moving
uniform sampler2D map;
uniform sampler2D categories;
uniform vec3 unknownColour;
varying vec3 colour;

void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  // Near points grow a little, far ones stay visible; without perspective all are of one size.
  float scale = projectionMatrix[3][3] < 0.5 ? clamp(pixelsPerUnit / -seen.z, 0.75, 2.2) : 1.0;
  gl_PointSize = size * scale;
  float kind = category < 0.5 ? shown.x : category < 1.5 ? shown.y : shown.z;
  if (kind < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside of what is drawn
  if (source == 2) {
    colour = texture2D(categories, vec2((category + 0.5) / 16.0, 0.5)).rgb;
    return;
  }
  float value = source == 0 ? compensated : source == 1 ? doppler : source == 3 ? residual : position.z - ground;
  float share = (value - range.x) / (range.y - range.x);
  colour = value < ${(UNKNOWN / 2).toExponential()} ? unknownColour
                                                   : texture2D(map, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb;
}`;

const fragmentShader = `
varying vec3 colour;
uniform float roundFrom;
uniform float size;
void main() {
  if (size > roundFrom) {
    vec2 away = gl_PointCoord - 0.5;
    if (dot(away, away) > 0.25) discard;
  }
  gl_FragColor = vec4(colour, 1.0);
}`;

// Larger discs behind the points of one object: a rim about all of it, while each point keeps the colour that tells
// something.
const rimVertexShader = `
attribute float label;
uniform float size;
uniform float selected;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z += 0.002 * gl_Position.w;
  gl_PointSize = 2.2 * size + 5.0;
  if (abs(label - selected) > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const rimFragmentShader = `
uniform vec3 selectedColour;
void main() {
  vec2 away = gl_PointCoord - 0.5;
  if (dot(away, away) > 0.25) discard;
  gl_FragColor = vec4(selectedColour, 1.0);
}`;

// The tables hold colours as the screen shows them; nothing turns them into light and back.
function texture(bytes, filter) {
  const made = new DataTexture(bytes, bytes.length / 4, 1, RGBAFormat);
  made.magFilter = filter;
  made.minFilter = filter;
  made.wrapS = ClampToEdgeWrapping;
  made.needsUpdate = true;
  return made;
}

/** 16 colours: not used, static, moving without object, then the objects' colours. */
function categoryTable(ground) {
  const marks = markColours(ground);
  const table = new Uint8Array(4 * 16);
  const colours = [marks.unused, marks.still, marks.moving];
  for (let k = 0; k < ID_COLOURS; ++k) colours.push(idColour(k, ground));
  colours.forEach((colour, k) => table.set([...rgb(colour), 255], 4 * k));
  return table;
}

/** What the shader takes a label for: 0 not used, 1 static, 2 moving, 3 + colour of the object. */
export function categoriesOf(labels, objectIds, into) {
  for (let i = 0; i < labels.length; ++i) {
    const label = labels[i];
    into[i] = label < 3 ? label : objectIds[label - 3] === undefined ? 2 : 3 + idColourIndex(objectIds[label - 3]);
  }
  return into;
}

const asVector = (hex) => new Color().setRGB(...rgb(hex).map((value) => value / 255));

export function createScanPoints() {
  let capacity = 0;
  const geometry = new BufferGeometry();
  const uniforms = {
    source: { value: 0 }, range: { value: new Vector2(-1, 1) }, ground: { value: 0 }, size: { value: 2 },
    pixelsPerUnit: { value: 20 }, shown: { value: [1, 1, 1] }, roundFrom: { value: 2.6 },
    map: { value: null }, categories: { value: null }, unknownColour: { value: new Color() },
    selected: { value: -1 }, selectedColour: { value: new Color() },
  };
  const points = new Points(geometry, new ShaderMaterial({ uniforms, vertexShader, fragmentShader }));
  points.frustumCulled = false;
  points.visible = false;
  const rim = new Points(geometry, new ShaderMaterial({ uniforms, vertexShader: rimVertexShader, fragmentShader: rimFragmentShader }));
  rim.frustumCulled = false;
  rim.visible = false;
  points.add(rim);

  function reserve(count) {
    if (count <= capacity) return;
    capacity = Math.ceil(count * 1.1);
    geometry.dispose();
    const add = (name, width, Type) =>
      geometry.setAttribute(name, new BufferAttribute(new Type(width * capacity), width).setUsage(DynamicDrawUsage));
    add('position', 3, Float32Array);
    for (const name of ['doppler', 'compensated', 'residual']) add(name, 1, Float32Array);
    add('category', 1, Uint8Array);
    add('label', 1, Uint8Array);
  }

  /** Puts `count` of the values, evenly picked, into an attribute. */
  function fill(name, values, count) {
    const attribute = geometry.getAttribute(name);
    const width = attribute.itemSize;
    const all = values.length / width;
    if (count === all) {
      attribute.array.set(values);
    } else {
      for (let k = 0; k < count; ++k) {
        const from = width * Math.floor((k * all) / count);
        for (let c = 0; c < width; ++c) attribute.array[width * k + c] = values[from + c];
      }
    }
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, width * count);
    attribute.needsUpdate = true;
  }

  let categoryBuffer = new Uint8Array(0);
  return {
    object: points,
    reserve,
    /**
     * @param {import('../bytes.js').Scan|null} scan
     * @param {number[]} objectIds of the frame's list
     * @param {number} [most] draws not more than so many of the points
     */
    show(scan, objectIds, most = Infinity) {
      points.visible = scan !== null && scan.count > 0;
      if (!points.visible) return;
      const count = Math.min(scan.count, most);
      reserve(scan.count);
      if (categoryBuffer.length < scan.count) categoryBuffer = new Uint8Array(capacity);
      fill('position', scan.positions, count);
      for (const name of ['doppler', 'compensated', 'residual']) fill(name, scan[name], count);
      fill('category', categoriesOf(scan.label, objectIds, categoryBuffer.subarray(0, scan.count)), count);
      fill('label', scan.label, count);
      geometry.setDrawRange(0, count);
    },
    /** @param {number|null} label of the points that stand out: 3 + place of their object in the list of the scan's frame */
    standOut(label) {
      uniforms.selected.value = label ?? -1;
      rim.visible = label !== null;
    },
    /** @param {{source: number, map: string}} colouring @param {[number, number]} range */
    colourBy(colouring, range, ground) {
      uniforms.source.value = colouring.source;
      uniforms.range.value.set(...range);
      uniforms.map.value?.dispose();
      uniforms.categories.value?.dispose();
      const map = colouring.map === 'categories' ? 'sequential' : colouring.map;
      uniforms.map.value = texture(lookupTable(map, ground), LinearFilter);
      uniforms.categories.value = texture(categoryTable(ground), NearestFilter);
      uniforms.selectedColour.value = asVector(markColours(ground).selected);
      uniforms.unknownColour.value = asVector(markColours(ground).unknown);
    },
    /** Height of the ground in the sensor frame, m. */
    setGroundHeight(height) { uniforms.ground.value = height; },
    setSize(size) { uniforms.size.value = size; },
    setShown(unused, still, moving) { uniforms.shown.value = [unused, still, moving].map(Number); },
  };
}
