// The rules of 3D Tiles 1.1 that a tileset.json and its GLB tiles must keep.
//   node check_tileset.mjs FOLDER|tileset.json...
// Checked: asset version; volumes, errors, refine, transforms well formed; a child's error never above its parent's,
// leaves with content have 0; URIs resolve, each GLB below the folder is used exactly once; every vertex of a tile lies
// in the tile's own volume and in those of all its ancestors; a parent's volume holds its descendants' volumes.
import { existsSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';
import { Report, IDENTITY, files_below, geodetic, multiply, open_glb, positions_z_up, transform } from './glb.mjs';

const TOLERANCE = 0.002; // m: float32 positions, and Bowring's formula
const report = new Report('check_tileset');
let tiles = 0;
let vertices = 0;

const finite = (list, length) => Array.isArray(list) && list.length === length && list.every(Number.isFinite);

function check_transform(m, where) {
  if (!finite(m, 16)) return report.error(where, 'transform is not 16 finite numbers');
  if (m[3] !== 0 || m[7] !== 0 || m[11] !== 0 || m[15] !== 1) report.error(where, 'last row of the transform is not 0 0 0 1');
  const axes = [m.slice(0, 3), m.slice(4, 7), m.slice(8, 11)];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  for (let i = 0; i < 3; ++i)
    for (let j = i; j < 3; ++j)
      if (Math.abs(dot(axes[i], axes[j]) - (i === j ? 1 : 0)) > 1e-9) report.error(where, 'transform is not orthonormal');
  const [a, b, c] = axes;
  const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  if (dot(cross, c) < 0) report.error(where, 'transform mirrors');
}

/** A function that tells how far (m) an ECEF point lies outside the volume, or null where the volume is malformed. */
function volume_of(tile, matrix, where) {
  const volume = tile.boundingVolume;
  const kinds = ['box', 'region', 'sphere'].filter((k) => volume?.[k] !== undefined);
  if (kinds.length !== 1) {
    report.error(where, 'boundingVolume needs exactly one of box, region, sphere');
    return null;
  }
  if (volume.region) {
    const r = volume.region;
    if (!finite(r, 6)) return report.error(where, 'region is not 6 finite numbers'), null;
    const [w, s, e, n, low, high] = r;
    const pi = Math.PI + 1e-12;
    if (Math.abs(w) > pi || Math.abs(e) > pi || Math.abs(s) > pi / 2 || Math.abs(n) > pi / 2) report.error(where, 'region beyond the Earth');
    if (s > n) report.error(where, 'region: south > north');
    if (low > high) report.error(where, 'region: lowest height above the highest');
    const outside = (p) => {
      const [lon, lat, h] = geodetic(p);
      const width = Math.max(Math.cos(lat), 1e-6) * 6.37e6;
      const east = w <= e ? Math.max(w - lon, lon - e, 0) : lon >= w || lon <= e ? 0 : Math.min(w - lon, lon - e);
      return Math.max(east * width, (s - lat) * 6.37e6, (lat - n) * 6.37e6, low - h, h - high, 0);
    };
    return { outside, corners: null };
  }
  if (volume.box) {
    const b = volume.box;
    if (!finite(b, 12)) return report.error(where, 'box is not 12 finite numbers'), null;
    const axes = [b.slice(3, 6), b.slice(6, 9), b.slice(9, 12)];
    const centre = transform(matrix, b);
    const world = axes.map((a) => transform([...matrix.slice(0, 12), 0, 0, 0, 1], a));
    const outside = (p) => {
      const d = [p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]];
      return Math.max(
        ...world.map((a) => {
          const length = Math.hypot(...a);
          if (length === 0) return Math.hypot(...d);
          return Math.abs(d[0] * a[0] + d[1] * a[1] + d[2] * a[2]) / length - length;
        }),
        0,
      );
    };
    const corners = [];
    for (const i of [-1, 1]) for (const j of [-1, 1]) for (const k of [-1, 1])
      corners.push([0, 1, 2].map((c) => centre[c] + i * world[0][c] + j * world[1][c] + k * world[2][c]));
    return { outside, corners };
  }
  const s = volume.sphere;
  if (!finite(s, 4) || s[3] < 0) return report.error(where, 'sphere is not 3 numbers and a radius'), null;
  const centre = transform(matrix, s);
  return { outside: (p) => Math.hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) - s[3], corners: null };
}

/** Region within region is checked by numbers, everything with corners by its corners. */
function check_inside(child, childVolume, parent, parentVolume, where) {
  if (childVolume.corners) {
    const worst = Math.max(...childVolume.corners.map(parentVolume.outside));
    if (worst > TOLERANCE) report.error(where, `its box sticks ${worst.toFixed(3)} m out of an ancestor's volume`);
  }
  const [c, p] = [child.boundingVolume.region, parent.boundingVolume.region];
  if (c && p && p[0] <= p[2]) {
    const ok = c[0] >= p[0] - 1e-12 && c[2] <= p[2] + 1e-12 && c[1] >= p[1] - 1e-12 && c[3] <= p[3] + 1e-12;
    if (!ok || c[0] > c[2] || c[4] < p[4] - 1e-9 || c[5] > p[5] + 1e-9) report.error(where, "its region is not inside an ancestor's");
  }
}

function check_content(content, chain, matrix, base, used, where) {
  if (typeof content.uri !== 'string' || content.uri === '') return report.error(where, 'content without uri');
  const path = normalize(join(base, decodeURIComponent(content.uri)));
  if (!existsSync(path) || !statSync(path).isFile()) return report.error(where, `${content.uri} does not exist`);
  if (used.has(path)) report.error(where, `${content.uri} is used twice`);
  used.add(path);
  let points;
  try {
    points = positions_z_up(open_glb(readFileSync(path)));
  } catch (error) {
    return report.error(where, `${content.uri}: ${error.message}`);
  }
  if (points.length === 0) report.warn(where, `${content.uri} shows nothing`);
  const worst = chain.map(() => 0);
  for (const p of points) {
    const world = transform(matrix, p);
    chain.forEach(({ volume }, i) => (worst[i] = Math.max(worst[i], volume.outside(world))));
  }
  vertices += points.length;
  worst.forEach((w, i) => {
    if (!(w <= TOLERANCE))
      report.error(where, `content lies ${w.toFixed(3)} m outside the volume of ${i === chain.length - 1 ? 'its tile' : 'an ancestor'}`);
  });
}

function check_tile(tile, parent, chain, matrix, base, used, where) {
  if (!Number.isFinite(tile.geometricError) || tile.geometricError < 0) report.error(where, 'geometricError is not a number >= 0');
  if (parent && tile.geometricError > parent.geometricError) report.error(where, "geometricError above the parent's");
  if (!parent && tile.refine === undefined) report.error(where, 'the root needs refine');
  if (tile.refine !== undefined && !['ADD', 'REPLACE'].includes(tile.refine)) report.error(where, `refine ${tile.refine}`);
  let own = matrix;
  if (tile.transform) {
    check_transform(tile.transform, where);
    if (finite(tile.transform, 16)) own = multiply(matrix, tile.transform);
  }
  const volume = volume_of(tile, own, where);
  if (!volume) return;
  for (const up of chain) check_inside(tile, volume, up.tile, up.volume, where);
  const next = [...chain, { tile, volume }];
  const children = tile.children ?? [];
  if (tile.children && children.length === 0) report.error(where, 'children is empty');
  if (children.length === 0 && tile.geometricError !== 0) report.error(where, 'a leaf has geometricError 0');
  if (parent && children.length === 0 && !tile.content && !tile.contents) report.error(where, 'a leaf without content');
  if (parent && children.length === 1 && !tile.content) report.warn(where, 'an inner node with one child and no content');
  if (tile.content && tile.contents) report.error(where, 'content and contents exclude each other');
  for (const content of tile.contents ?? (tile.content ? [tile.content] : [])) {
    ++tiles;
    check_content(content, next, own, base, used, where);
  }
  children.forEach((child, i) => check_tile(child, tile, next, own, base, used, `${where}/${i}`));
}

const args = process.argv.slice(2);
if (args.length === 0) {
  console.error('usage: node check_tileset.mjs FOLDER|tileset.json...');
  process.exit(2);
}
for (const argument of args) {
  const path = statSync(argument).isDirectory() ? join(argument, 'tileset.json') : argument;
  const base = dirname(path);
  let tileset;
  try {
    tileset = JSON.parse(readFileSync(path, 'utf8'));
  } catch (error) {
    report.error(path, error.message);
    continue;
  }
  if (tileset.asset?.version !== '1.1') report.error(path, `asset.version is ${tileset.asset?.version}`);
  if (!Number.isFinite(tileset.geometricError) || tileset.geometricError < 0) report.error(path, 'geometricError is not a number >= 0');
  if (!tileset.root) {
    report.error(path, 'no root');
    continue;
  }
  if (tileset.geometricError < tileset.root.geometricError) report.error(path, "the tileset's geometricError is below its root's");
  const used = new Set();
  check_tile(tileset.root, null, [], IDENTITY, base, used, `${path} root`);
  // A single-file copy of the build lies beside the tiles on purpose.
  const folder = join(base, 'tiles');
  if (existsSync(folder))
    for (const file of files_below(folder, ['.glb'])) if (!used.has(normalize(file))) report.error(path, `${file} is used by no tile`);
}
report.finish(`${tiles} tiles, ${vertices} vertices`);
