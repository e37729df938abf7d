// The ground that the houses stand on. Where their feet lie at different heights (a build with --terrain) it is a
// surface through them: means of ever larger squares, the larger ones wherever the smaller have no house, and near by
// the feet themselves. Away from all houses it comes down to the plane (Frame.ground_at). Where all feet lie in the
// plane nothing is drawn beside that.
import { BufferAttribute, BufferGeometry, Group, Mesh, MeshLambertMaterial, Sphere, Vector3 } from 'three';
import { Frame } from './frame';

const SQUARE = 80; // m, the smallest squares with means; so far reach single feet
const LEVELS = 5; // each of squares twice as large: 1280 m at last
const CHUNK = 640; // m, a mesh each
const FINE = 40; // cells along a near chunk's side
const COARSE = 8; // and along a far one's
const NEAR = 1100; // m to a near chunk
const FAR = 4200; // m, beyond which the plane must do
const FOOT = 12; // m: of feet nearer to each other one is kept
const MOST_FEET = 120000; // beyond, the farthest are given up
const FLAT = 0.5; // m that feet may be off the plane
const CLEARANCE = 0.15; // m that the ground stays below the feet: a doorstep
const LARGEST = 25; // m from a house's middle to its sides, as far as they count
const REACH = SQUARE - LARGEST; // m from a house's sides that its foot counts
const PAUSE = 250; // ms between two takes of new feet while tiles arrive

/** A house's foot: its middle, half its size, and how far it is above the plane. */
export interface Foot {
  x: number;
  z: number;
  half_x: number;
  half_z: number;
  above: number;
}
interface Square {
  count: number;
  x: number;
  z: number;
  above: number;
}
interface Chunk {
  cells: number;
  made: number;
  heights: Float32Array;
  mesh: Mesh;
}

/** One number for a pair of whole numbers. */
const key_of = (i: number, j: number): number => (i + 32768) * 65536 + (j + 32768);

export class Ground {
  readonly group = new Group();
  /** Where houses stand at different heights. */
  hilly = false;
  private readonly material: MeshLambertMaterial;
  private readonly feet = new Map<number, Foot>();
  /** Feet by square. */
  private readonly near = new Map<number, Foot[]>();
  private readonly levels: Map<number, Square>[] = Array.from({ length: LEVELS }, () => new Map<number, Square>());
  /** Means of squares, by level, as long as no foot comes or goes. */
  private readonly values = Array.from({ length: LEVELS }, () => new Map<number, number>());
  private readonly chunks = new Map<number, Chunk>();
  private wanted: { i: number; j: number; cells: number }[] = [];
  private off_plane = 0;
  private version = 0;
  private changed_at = 0;
  private pending = false;
  private readonly focus = new Vector3(Infinity, 0, 0);

  constructor(colour: string) {
    this.material = new MeshLambertMaterial({ color: colour });
  }

  /** Height in the page's frame. */
  at(x: number, z: number): number {
    return Frame.ground_at(x, z) + this.above(x, z);
  }

  /** Height above the plane, of the triangles that are drawn. */
  above(x: number, z: number): number {
    if (!this.hilly) return 0;
    const i = Math.floor(x / CHUNK),
      j = Math.floor(z / CHUNK);
    const chunk = this.chunks.get(key_of(i, j));
    if (!chunk) return 0;
    const { cells, heights } = chunk;
    const u = (x / CHUNK - i) * cells,
      v = (z / CHUNK - j) * cells;
    const a = Math.min(cells - 1, Math.floor(u)),
      b = Math.min(cells - 1, Math.floor(v));
    const s = u - a,
      t = v - b,
      at = b * (cells + 1) + a;
    const h00 = heights[at]!,
      h10 = heights[at + 1]!,
      h01 = heights[at + cells + 1]!,
      h11 = heights[at + cells + 2]!;
    return s > t ? h00 + s * (h10 - h00) + t * (h11 - h10) : h00 + t * (h01 - h00) + s * (h11 - h01);
  }

  /** How far a ray goes before it meets a hill, at most `reach`. */
  free(from: Vector3, direction: Vector3, reach: number): number {
    if (!this.hilly) return reach;
    const at = new Vector3();
    for (let t = 2; t < reach; t += Math.max(2, 0.01 * t)) {
      at.copy(from).addScaledVector(direction, t);
      if (at.y < this.at(at.x, at.z) - 0.2) return t;
    }
    return reach;
  }

  /** Takes the feet of a tile. Places that have one already keep it: it is that of another level of detail. */
  add(feet: Foot[]): void {
    const fresh = new Map<number, Foot>();
    for (const foot of feet) {
      const key = key_of(Math.floor(foot.x / FOOT), Math.floor(foot.z / FOOT));
      if (this.feet.has(key) || foot.above >= (fresh.get(key)?.above ?? Infinity)) continue;
      fresh.set(key, {
        ...foot,
        half_x: Math.min(LARGEST, 0.8 * foot.half_x),
        half_z: Math.min(LARGEST, 0.8 * foot.half_z),
      });
    }
    if (!fresh.size) return;
    for (const [key, foot] of fresh) {
      this.feet.set(key, foot);
      this.count(foot, 1);
      const square = key_of(Math.floor(foot.x / SQUARE), Math.floor(foot.z / SQUARE));
      const there = this.near.get(square);
      if (there) there.push(foot);
      else this.near.set(square, [foot]);
    }
    if (this.feet.size > MOST_FEET) this.give_up_far();
    this.pending = true;
  }

  /** Makes the surface about a place, a little at a time. loading: more feet may come at once. True: it changed. */
  update(about: Vector3, loading: boolean): boolean {
    const now = performance.now();
    let listed = false;
    if (this.pending && (!loading || now - this.changed_at > PAUSE)) {
      this.pending = false;
      this.changed_at = now;
      ++this.version;
      for (const values of this.values) values.clear();
      this.hilly = this.off_plane >= Math.max(3, 0.02 * this.feet.size);
      listed = true;
    }
    if (!this.hilly) {
      if (!this.chunks.size) return false;
      for (const key of [...this.chunks.keys()]) this.remove(key);
      return true;
    }
    if (listed || Math.hypot(about.x - this.focus.x, about.z - this.focus.z) > 150) this.list(about);
    let changed = false;
    while (this.wanted.length && performance.now() - now < 6) {
      const { i, j, cells } = this.wanted.shift()!;
      changed = this.make(i, j, cells) || changed;
    }
    return changed;
  }

  get settled(): boolean {
    return !this.pending && (!this.hilly || !this.wanted.length);
  }

  get bytes(): number {
    let bytes = this.feet.size * 160;
    for (const { heights } of this.chunks.values()) bytes += 8 * heights.byteLength;
    return bytes;
  }

  dispose(): void {
    for (const key of [...this.chunks.keys()]) this.remove(key);
    this.material.dispose();
  }

  // ---- heights

  private count(foot: Foot, sign: 1 | -1): void {
    if (Math.abs(foot.above) > FLAT) this.off_plane += sign;
    this.levels.forEach((squares, level) => {
      const size = SQUARE * 2 ** level,
        key = key_of(Math.floor(foot.x / size), Math.floor(foot.z / size));
      let square = squares.get(key);
      if (!square) squares.set(key, (square = { count: 0, x: 0, z: 0, above: 0 }));
      square.count += sign;
      square.x += sign * foot.x;
      square.z += sign * foot.z;
      square.above += sign * foot.above;
      if (!square.count) squares.delete(key);
    });
  }

  /** The mean at the middle of a square: of its own feet, or where they are few mostly that of larger squares. */
  private value(level: number, i: number, j: number): number {
    const key = key_of(i, j),
      known = this.values[level]!.get(key);
    if (known !== undefined) return known;
    const size = SQUARE * 2 ** level,
      square = this.levels[level]!.get(key);
    let value = this.mean(level + 1, (i + 0.5) * size, (j + 0.5) * size);
    if (square) {
      const { count, x, z, above } = square;
      value += ((above / count - this.mean(level + 1, x / count, z / count)) * count) / (count + 0.3);
    }
    this.values[level]!.set(key, value);
    return value;
  }

  /** Between the middles of squares. */
  private mean(level: number, x: number, z: number): number {
    if (level >= LEVELS) return 0;
    const size = SQUARE * 2 ** level,
      u = x / size - 0.5,
      v = z / size - 0.5;
    const i = Math.floor(u),
      j = Math.floor(v);
    const s = smooth(u - i),
      t = smooth(v - j);
    const top = this.value(level, i, j) * (1 - s) + this.value(level, i + 1, j) * s;
    return top * (1 - t) + (this.value(level, i, j + 1) * (1 - s) + this.value(level, i + 1, j + 1) * s) * t;
  }

  private height(x: number, z: number): number {
    const mean = this.mean(0, x, z);
    const i = Math.floor(x / SQUARE),
      j = Math.floor(z / SQUARE);
    let sum = 0,
      weights = 1 / 1200;
    for (let a = i - 1; a <= i + 1; ++a)
      for (let b = j - 1; b <= j + 1; ++b)
        for (const foot of this.near.get(key_of(a, b)) ?? []) {
          const dx = Math.max(0, Math.abs(x - foot.x) - foot.half_x),
            dz = Math.max(0, Math.abs(z - foot.z) - foot.half_z),
            d = dx * dx + dz * dz,
            inside = 1 - d / (REACH * REACH);
          if (inside <= 0) continue;
          const weight = (inside * inside) / (d + 12);
          sum += weight * (foot.above - mean);
          weights += weight;
        }
    return Math.max(0, mean + sum / weights - CLEARANCE);
  }

  // ---- meshes

  private list(about: Vector3): void {
    this.focus.copy(about);
    const middle_i = Math.floor(about.x / CHUNK),
      middle_j = Math.floor(about.z / CHUNK),
      reach = Math.ceil(FAR / CHUNK);
    const found: { i: number; j: number; cells: number; distance: number }[] = [];
    const keep = new Set<number>();
    for (let i = middle_i - reach; i <= middle_i + reach; ++i)
      for (let j = middle_j - reach; j <= middle_j + reach; ++j) {
        const distance = Math.hypot((i + 0.5) * CHUNK - about.x, (j + 0.5) * CHUNK - about.z);
        if (distance > FAR || !this.near_houses(i, j)) continue;
        const key = key_of(i, j),
          old = this.chunks.get(key);
        keep.add(key);
        const cells = distance < (old?.cells === FINE ? 1.2 : 1) * NEAR ? FINE : COARSE;
        if (old?.made !== this.version || old.cells !== cells) found.push({ i, j, cells, distance });
      }
    for (const key of [...this.chunks.keys()]) if (!keep.has(key)) this.remove(key);
    this.wanted = found.sort((a, b) => a.distance - b.distance);
  }

  /** Whether houses raise a chunk's ground: the largest squares reach a square and a half. */
  private near_houses(i: number, j: number): boolean {
    const scale = CHUNK / (SQUARE * 2 ** (LEVELS - 1)),
      a = Math.floor(i * scale),
      b = Math.floor(j * scale);
    for (let c = a - 1; c <= a + 1; ++c)
      for (let d = b - 1; d <= b + 1; ++d) if (this.levels[LEVELS - 1]!.has(key_of(c, d))) return true;
    return false;
  }

  private make(i: number, j: number, cells: number): boolean {
    const key = key_of(i, j),
      old = this.chunks.get(key),
      cell = CHUNK / cells,
      side = cells + 1;
    // With a border of one node, for normals that agree with the next chunk's.
    const wide = cells + 3,
      all = new Float32Array(wide * wide);
    for (let b = 0; b < wide; ++b)
      for (let a = 0; a < wide; ++a)
        all[b * wide + a] = this.height(i * CHUNK + (a - 1) * cell, j * CHUNK + (b - 1) * cell);
    const heights = new Float32Array(side * side);
    for (let b = 0; b < side; ++b) heights.set(all.subarray((b + 1) * wide + 1, (b + 1) * wide + 1 + side), b * side);
    if (old?.cells === cells && heights.every((height, n) => Math.abs(height - old.heights[n]!) < 0.01)) {
      old.made = this.version;
      return false;
    }
    const positions = new Float32Array(3 * heights.length),
      normals = new Int8Array(4 * heights.length),
      normal = new Vector3();
    let low = Infinity,
      high = -Infinity;
    for (let b = 0; b < side; ++b)
      for (let a = 0; a < side; ++a) {
        const n = b * side + a,
          w = (b + 1) * wide + a + 1;
        const y = heights[n]! + Frame.ground_at(i * CHUNK + a * cell, j * CHUNK + b * cell);
        positions.set([a * cell, y, b * cell], 3 * n);
        normal.set(all[w - 1]! - all[w + 1]!, 2 * cell, all[w - wide]! - all[w + wide]!).normalize();
        normals.set([127 * normal.x, 127 * normal.y, 127 * normal.z], 4 * n);
        low = Math.min(low, y);
        high = Math.max(high, y);
      }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 4, true));
    geometry.setIndex(triangles(cells));
    geometry.boundingSphere = new Sphere(
      new Vector3(CHUNK / 2, (low + high) / 2, CHUNK / 2),
      Math.hypot(CHUNK / Math.SQRT2, (high - low) / 2),
    );
    if (old) {
      old.mesh.geometry.dispose();
      old.mesh.geometry = geometry;
      Object.assign(old, { cells, heights, made: this.version });
      return true;
    }
    const mesh = new Mesh(geometry, this.material);
    mesh.position.set(i * CHUNK, 0, j * CHUNK);
    mesh.receiveShadow = true;
    // After the houses, before the plane, which it hides.
    mesh.renderOrder = 0.5;
    this.group.add(mesh);
    mesh.updateMatrixWorld(true);
    this.chunks.set(key, { cells, heights, mesh, made: this.version });
    return true;
  }

  private remove(key: number): void {
    const { mesh } = this.chunks.get(key)!;
    mesh.removeFromParent();
    mesh.geometry.dispose();
    this.chunks.delete(key);
  }

  private give_up_far(): void {
    const far = (foot: Foot) => Math.hypot(foot.x - this.focus.x, foot.z - this.focus.z);
    const order = [...this.feet].sort((a, b) => far(a[1]) - far(b[1]));
    for (const [key, foot] of order.slice(Math.floor(0.8 * MOST_FEET))) {
      this.feet.delete(key);
      this.count(foot, -1);
      const square = key_of(Math.floor(foot.x / SQUARE), Math.floor(foot.z / SQUARE));
      const left = this.near.get(square)!.filter((other) => other !== foot);
      if (left.length) this.near.set(square, left);
      else this.near.delete(square);
    }
  }
}

const smooth = (t: number): number => t * t * (3 - 2 * t);

/** Two triangles for each cell, split from north-west to south-east. */
function triangles(cells: number): BufferAttribute {
  const index = new Uint16Array(6 * cells * cells);
  let at = 0;
  for (let b = 0; b < cells; ++b)
    for (let a = 0; a < cells; ++a) {
      const n = b * (cells + 1) + a;
      index.set([n, n + cells + 2, n + 1, n, n + cells + 1, n + cells + 2], at);
      at += 6;
    }
  return new BufferAttribute(index, 1);
}
