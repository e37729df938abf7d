// What the checks share: finding files, opening a GLB, reading accessors, placing points on the Earth.
import { readdirSync, statSync } from 'node:fs';
import { join } from 'node:path';

/** Files with one of the endings: `path` itself, or those below it, sorted. */
export function files_below(path, endings) {
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path, { recursive: true })
    .map((name) => join(path, name))
    .filter((name) => endings.some((e) => name.endsWith(e)) && statSync(name).isFile())
    .sort();
}

/** {json, bin} of a GLB; throws with a reason where the container is broken. */
export function open_glb(bytes) {
  if (bytes.length < 20 || bytes.toString('latin1', 0, 4) !== 'glTF') throw new Error('not a GLB');
  if (bytes.readUInt32LE(4) !== 2) throw new Error('not version 2');
  if (bytes.readUInt32LE(8) !== bytes.length) throw new Error(`length ${bytes.readUInt32LE(8)} instead of ${bytes.length}`);
  let json = null;
  let bin = null;
  for (let at = 12; at < bytes.length; ) {
    const length = bytes.readUInt32LE(at);
    const type = bytes.readUInt32LE(at + 4);
    if (length % 4 !== 0 || at + 8 + length > bytes.length) throw new Error('broken chunk');
    const chunk = bytes.subarray(at + 8, at + 8 + length);
    if (type === 0x4e4f534a) json = JSON.parse(chunk.toString('utf8'));
    if (type === 0x004e4942) bin = chunk;
    at += 8 + length;
  }
  if (!json) throw new Error('no JSON chunk');
  return { json, bin: bin ?? Buffer.alloc(0) };
}

const COMPONENTS = {
  5120: [1, 'getInt8', 127],
  5121: [1, 'getUint8', 255],
  5122: [2, 'getInt16', 32767],
  5123: [2, 'getUint16', 65535],
  5125: [4, 'getUint32', 4294967295],
  5126: [4, 'getFloat32', 1],
};
const WIDTH = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

/** The values of an accessor as one flat array, normalised integers decoded. */
export function read_accessor({ json, bin }, index) {
  const accessor = json.accessors[index];
  const view = json.bufferViews[accessor.bufferView];
  const [size, get, scale] = COMPONENTS[accessor.componentType];
  const width = WIDTH[accessor.type];
  const stride = view.byteStride ?? size * width;
  const data = new DataView(bin.buffer, bin.byteOffset + (view.byteOffset ?? 0), view.byteLength);
  const out = new Float64Array(accessor.count * width);
  for (let i = 0; i < accessor.count; ++i)
    for (let c = 0; c < width; ++c) {
      const raw = data[get]((accessor.byteOffset ?? 0) + i * stride + c * size, true);
      out[i * width + c] = accessor.normalized ? Math.max(raw / scale, -1) : raw;
    }
  return out;
}

export const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** a·b for column-major 4 × 4 matrices. */
export function multiply(a, b) {
  const out = new Array(16).fill(0);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r) for (let k = 0; k < 4; ++k) out[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
  return out;
}

export function transform(m, [x, y, z]) {
  return [
    m[0] * x + m[4] * y + m[8] * z + m[12],
    m[1] * x + m[5] * y + m[9] * z + m[13],
    m[2] * x + m[6] * y + m[10] * z + m[14],
  ];
}

export function node_matrix(node) {
  if (node.matrix) return node.matrix;
  const [tx, ty, tz] = node.translation ?? [0, 0, 0];
  const [sx, sy, sz] = node.scale ?? [1, 1, 1];
  const [x, y, z, w] = node.rotation ?? [0, 0, 0, 1];
  return [
    (1 - 2 * (y * y + z * z)) * sx, 2 * (x * y + z * w) * sx, 2 * (x * z - y * w) * sx, 0,
    2 * (x * y - z * w) * sy, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z + x * w) * sy, 0,
    2 * (x * z + y * w) * sz, 2 * (y * z - x * w) * sz, (1 - 2 * (x * x + y * y)) * sz, 0,
    tx, ty, tz, 1,
  ];
}

/** Calls visit(primitive, matrix) for every primitive of the default scene. */
export function each_primitive(glb, visit) {
  const { json } = glb;
  const walk = (index, parent) => {
    const node = json.nodes[index];
    const matrix = multiply(parent, node_matrix(node));
    if (node.mesh !== undefined) for (const p of json.meshes[node.mesh].primitives) visit(p, matrix, node);
    for (const child of node.children ?? []) walk(child, matrix);
  };
  for (const index of json.scenes?.[json.scene ?? 0]?.nodes ?? []) walk(index, IDENTITY);
}

/** The matrices of a node's instances (EXT_mesh_gpu_instancing), or null where it has none. */
export function instance_matrices(glb, node) {
  const attributes = node.extensions?.EXT_mesh_gpu_instancing?.attributes;
  if (!attributes) return null;
  const read = (name) => (attributes[name] === undefined ? null : read_accessor(glb, attributes[name]));
  const t = read('TRANSLATION'), r = read('ROTATION'), s = read('SCALE');
  const count = glb.json.accessors[Object.values(attributes)[0]].count;
  return Array.from({ length: count }, (_, i) =>
    node_matrix({
      translation: t ? t.subarray(3 * i, 3 * i + 3) : undefined,
      rotation: r ? r.subarray(4 * i, 4 * i + 4) : undefined,
      scale: s ? s.subarray(3 * i, 3 * i + 3) : undefined,
    }));
}

/** The box of the vertices that a primitive uses: shapes share accessors, whose own bounds are those of all of them. */
function box_of(glb, primitive) {
  const p = read_accessor(glb, primitive.attributes.POSITION);
  const used = primitive.indices === undefined ? [...Array(p.length / 3).keys()] : read_accessor(glb, primitive.indices);
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  for (const i of used)
    for (let k = 0; k < 3; ++k) {
      min[k] = Math.min(min[k], p[3 * i + k]);
      max[k] = Math.max(max[k], p[3 * i + k]);
    }
  return { min, max };
}

/**
 * Every vertex of the default scene in the tile's frame (glTF's y up turned to z up, as 3D Tiles does); of what is
 * instanced the corners of its box.
 */
export function positions_z_up(glb) {
  const out = [];
  const instances = new Map();
  each_primitive(glb, (primitive, matrix, node) => {
    if (!instances.has(node)) instances.set(node, instance_matrices(glb, node));
    const places = instances.get(node);
    if (places) {
      const { min, max } = box_of(glb, primitive);
      for (const place of places)
        for (let corner = 0; corner < 8; ++corner) {
          const [x, y, z] = transform(multiply(matrix, place), min.map((low, k) => ((corner >> k) & 1 ? max[k] : low)));
          out.push([x, -z, y]);
        }
      return;
    }
    const p = read_accessor(glb, primitive.attributes.POSITION);
    for (let i = 0; i < p.length; i += 3) {
      const [x, y, z] = transform(matrix, [p[i], p[i + 1], p[i + 2]]);
      out.push([x, -z, y]);
    }
  });
  return out;
}

const A = 6378137;
const E2 = 6.69437999014e-3;

/** WGS 84 longitude, latitude (radians) and height of an Earth-centred point (Bowring, iterated). */
export function geodetic([x, y, z]) {
  const p = Math.hypot(x, y);
  let latitude = Math.atan2(z, p * (1 - E2));
  for (let i = 0; i < 6; ++i) {
    const n = A / Math.sqrt(1 - E2 * Math.sin(latitude) ** 2);
    latitude = Math.atan2(z + E2 * n * Math.sin(latitude), p);
  }
  const n = A / Math.sqrt(1 - E2 * Math.sin(latitude) ** 2);
  const height = p * Math.cos(latitude) + z * Math.sin(latitude) - (A * A) / n;
  return [Math.atan2(y, x), latitude, height];
}

export function ecef(longitude, latitude, height) {
  const n = A / Math.sqrt(1 - E2 * Math.sin(latitude) ** 2);
  return [
    (n + height) * Math.cos(latitude) * Math.cos(longitude),
    (n + height) * Math.cos(latitude) * Math.sin(longitude),
    (n * (1 - E2) + height) * Math.sin(latitude),
  ];
}

/** Column-major matrix from east, north, up at a place to Earth-centred coordinates. */
export function enu_to_ecef(longitude, latitude, height) {
  const [sl, cl, sp, cp] = [Math.sin(longitude), Math.cos(longitude), Math.sin(latitude), Math.cos(latitude)];
  return [-sl, cl, 0, 0, -sp * cl, -sp * sl, cp, 0, cp * cl, cp * sl, sp, 0, ...ecef(longitude, latitude, height), 1];
}

/** Collects problems of one run and ends it. */
export class Report {
  constructor(name) {
    this.name = name;
    this.errors = [];
    this.warnings = [];
  }
  error(where, what) {
    this.errors.push(`${where}: error: ${what}`);
  }
  warn(where, what) {
    this.warnings.push(`${where}: warning: ${what}`);
  }
  finish(summary) {
    for (const line of [...this.errors, ...this.warnings].slice(0, 100)) console.log(line);
    console.log(`${this.name}: ${summary}, ${this.errors.length} errors, ${this.warnings.length} warnings`);
    process.exit(this.errors.length > 0 ? 1 : 0);
  }
}
