// A tile as few meshes: its bodies in one, its windows and ornaments in cells of some metres, each coarse from afar and
// whole from near. Every vertex knows its feature, so houses are coloured by a small texture of one texel per feature.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  Group,
  Material,
  Matrix3,
  Matrix4,
  Mesh,
  NearestFilter,
  Quaternion,
  RGBAFormat,
  UnsignedByteType,
  Vector3,
} from 'three';
import type { Glb, Json, Values } from './glb';
import { painted_material } from './paint';
import { Table } from './table';

/** What a vertex belongs to; the shader treats them differently (paint.ts). */
const KIND = { body: 0, detail: 85, glass: 170, metal: 255 } as const;
const NO_FEATURE = 65535;
const CELL = 96; // m
const COARSE_TRIANGLES = 26;
const COARSE_SHARE = 0.94; // of an element's area
const TEXTURE_WIDTH = 256;

interface Shape {
  positions: Float32Array;
  normals: Float32Array;
  paint: Uint8Array;
  index: Uint32Array;
}

/** The windows and ornaments of a cell. */
export interface Cell {
  tile: TileModel;
  instances: number[];
  coarse: Mesh;
  whole: Mesh | null;
}

export class TileModel {
  readonly table: Table;
  readonly group = new Group();
  readonly cells: Cell[] = [];
  readonly features: DataTexture;
  readonly texels: Uint8Array;
  readonly material: Material;
  readonly body: Mesh | null;
  /** Rows of the table by the building that they belong to. */
  readonly rows_of = new Map<string, number[]>();
  /** The highest and lowest point and the middle of each feature, in the tile's frame: [x, y, z, top] each. */
  readonly extents: Float32Array;
  /** Of each building: where it stands, [west, north, east, south], and its lowest point, in the tile's frame. */
  readonly feet: { box: [number, number, number, number]; y: number }[] = [];
  private readonly bottoms: Float32Array;
  /** Rows that reach down to the foot of their building: not a part that hangs above another. */
  private readonly standing: Uint8Array;
  private readonly elements: Json[] = [];
  /** Of glTF meshes in `elements`. */
  private readonly numbers = new Map<number, number>();
  private readonly element_of: number[] = [];
  private readonly feature_of: number[] = [];
  private readonly matrices: Matrix4[] = [];
  private source_bytes = 0;

  /** name: tile, as in explanations: "15_35206_25947". */
  constructor(
    private readonly glb: Glb,
    readonly name: string,
  ) {
    this.table = new Table(glb);
    const rows = Math.max(1, this.table.count);
    this.texels = new Uint8Array(4 * TEXTURE_WIDTH * Math.ceil(rows / TEXTURE_WIDTH));
    this.features = new DataTexture(
      this.texels,
      TEXTURE_WIDTH,
      this.texels.length / 4 / TEXTURE_WIDTH,
      RGBAFormat,
      UnsignedByteType,
    );
    this.features.minFilter = this.features.magFilter = NearestFilter;
    this.features.needsUpdate = true;
    this.material = painted_material(this.features);
    this.extents = new Float32Array(4 * rows);
    this.bottoms = new Float32Array(rows).fill(Infinity);
    this.standing = new Uint8Array(rows);
    for (let row = 0; row < this.table.count; ++row) {
      const building = this.table.text('building', row) || this.table.text('id', row);
      const known = this.rows_of.get(building);
      if (known) known.push(row);
      else this.rows_of.set(building, [row]);
    }
    this.body = this.make_body();
    this.make_cells();
    this.group.userData.model = this;
  }

  /** Bytes kept beside what stands in the group's geometries: the file, from which near windows are made. */
  get kept_bytes(): number {
    return this.source_bytes + this.texels.length;
  }

  building_of(row: number): string {
    return this.table.text('building', row) || this.table.text('id', row);
  }

  /** Makes all of a cell's windows. The caller shows them and gives them back. */
  whole_mesh(cell: Cell): Mesh {
    const shapes = new Map<number, Shape>();
    return this.detail_mesh(cell.instances, (element) => {
      let shape = shapes.get(element);
      if (!shape) shapes.set(element, (shape = this.shape(this.elements[element]!)));
      return shape;
    });
  }

  dispose(): void {
    for (const cell of this.cells) {
      cell.coarse.geometry.dispose();
      cell.whole?.geometry.dispose();
    }
    this.body?.geometry.dispose();
    this.features.dispose();
    this.material.dispose();
  }

  // ---- bodies

  private make_body(): Mesh | null {
    const parts: { primitive: Json; matrix: Matrix4; index: Values | null; positions: Values; kind: number }[] = [];
    let vertices = 0,
      corners = 0;
    for (const { node, matrix } of this.glb.placed_nodes()) {
      const { primitives } = this.glb.json.meshes[node.mesh];
      if (node.extensions?.EXT_mesh_gpu_instancing) {
        this.add_instances(node, matrix);
        continue;
      }
      // A build with --instancing nodes: windows are nodes of their own, whose house the file does not tell.
      if (this.table.count && primitives.every((primitive: Json) => primitive.attributes._FEATURE_ID_0 === undefined)) {
        this.add_instance(matrix, this.element_number(node.mesh), NO_FEATURE);
        continue;
      }
      for (const primitive of primitives) {
        if ((primitive.mode ?? 4) !== 4) continue;
        const positions = this.glb.values(primitive.attributes.POSITION);
        const index = primitive.indices === undefined ? null : this.glb.values(primitive.indices);
        // What stands nowhere else is part of one mesh beside that of the solids.
        const kind = node.name === 'elements' ? KIND.detail : KIND.body;
        parts.push({ primitive, matrix, index, positions, kind });
        vertices += positions.count;
        corners += index ? index.count : positions.count;
      }
    }
    if (!vertices) return null;
    parts.sort((a, b) => a.kind - b.kind);
    const of_bodies = parts.reduce((sum, part) => sum + (part.kind === KIND.body ? part.positions.count : 0), 0);
    const out = new Vertices(vertices);
    const index = new Uint32Array(corners);
    let corner = 0;
    for (const part of parts) {
      const first = out.count;
      this.add_primitive(out, part.primitive, part.matrix, part.positions, part.kind);
      const count = part.index ? part.index.count : part.positions.count;
      for (let i = 0; i < count; ++i)
        index[corner++] = first + (part.index ? part.index.array[i * part.index.stride]! : i);
    }
    this.measure(out, of_bodies);
    const mesh = new Mesh(out.geometry(index), this.material);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.userData.model = this;
    this.group.add(mesh);
    return mesh;
  }

  private add_primitive(out: Vertices, primitive: Json, matrix: Matrix4, positions: Values, kind: number): void {
    const normals = primitive.attributes.NORMAL === undefined ? null : this.glb.values(primitive.attributes.NORMAL);
    const ids =
      primitive.attributes._FEATURE_ID_0 === undefined ? null : this.glb.values(primitive.attributes._FEATURE_ID_0);
    const colours = primitive.attributes.COLOR_0 === undefined ? null : this.glb.values(primitive.attributes.COLOR_0);
    const paint = painter(this.glb, primitive, colours, kind);
    const normal_matrix = new Matrix3().getNormalMatrix(matrix);
    const p = new Vector3(),
      n = new Vector3(0, 1, 0);
    for (let v = 0; v < positions.count; ++v) {
      read3(positions, v, p).applyMatrix4(matrix);
      if (normals) read3(normals, v, n).applyMatrix3(normal_matrix).normalize();
      const at = out.add(p, n, ids ? ids.array[v * ids.stride]! : NO_FEATURE);
      paint(v, out.paint, 4 * at);
    }
  }

  /** Where each feature stands, by the first vertices, and how far each vertex is above its feature's foot. */
  private measure(out: Vertices, of_bodies: number): void {
    const rows = this.table.count;
    const low = new Float32Array(3 * rows).fill(Infinity),
      high = new Float32Array(3 * rows).fill(-Infinity);
    for (let v = 0; v < of_bodies; ++v) {
      const row = out.features[2 * v]!;
      if (row >= rows) continue;
      for (let c = 0; c < 3; ++c) {
        const value = out.positions[3 * v + c]!;
        if (value < low[3 * row + c]!) low[3 * row + c] = value;
        if (value > high[3 * row + c]!) high[3 * row + c] = value;
      }
    }
    for (let row = 0; row < rows; ++row) {
      this.bottoms[row] = low[3 * row + 1]!;
      this.extents.set(
        [
          (low[3 * row]! + high[3 * row]!) / 2,
          low[3 * row + 1]!,
          (low[3 * row + 2]! + high[3 * row + 2]!) / 2,
          high[3 * row + 1]!,
        ],
        4 * row,
      );
    }
    for (const rows_there of this.rows_of.values()) {
      const box = [Infinity, Infinity, -Infinity, -Infinity] as [number, number, number, number];
      const lowest = Math.min(...rows_there.map((row) => this.bottoms[row]!));
      if (!Number.isFinite(lowest)) continue;
      for (const row of rows_there) {
        if (this.bottoms[row]! > lowest + 0.5) continue;
        this.standing[row] = 1;
        box[0] = Math.min(box[0], low[3 * row]!);
        box[1] = Math.min(box[1], low[3 * row + 2]!);
        box[2] = Math.max(box[2], high[3 * row]!);
        box[3] = Math.max(box[3], high[3 * row + 2]!);
      }
      this.feet.push({ box, y: lowest });
    }
    for (let v = 0; v < out.count; ++v)
      out.features[2 * v + 1] = this.above_foot(out.features[2 * v]!, out.positions[3 * v + 1]!);
  }

  /** Centimetres above the feature's foot; 0 only where that is the building's. */
  private above_foot(row: number, y: number): number {
    const foot = this.bottoms[row] ?? y;
    return Math.max(this.standing[row] ? 0 : 1, Math.min(65535, Math.round(100 * (y - foot)))) || 0;
  }

  // ---- windows and ornaments

  private add_instances(node: Json, matrix: Matrix4): void {
    const { attributes } = node.extensions.EXT_mesh_gpu_instancing as Json;
    const read = (name: string) => (attributes[name] === undefined ? null : this.glb.values(attributes[name]));
    const moved = read('TRANSLATION'),
      turned = read('ROTATION'),
      scaled = read('SCALE'),
      ids = read('_FEATURE_ID_0');
    const count = (moved ?? turned ?? scaled)?.count ?? 0;
    const element = this.element_number(node.mesh);
    const t = new Vector3(),
      q = new Quaternion(),
      s = new Vector3();
    for (let i = 0; i < count; ++i) {
      if (moved) read3(moved, i, t);
      if (turned) {
        const { array, stride, scale } = turned;
        q.set(
          array[i * stride]! * scale,
          array[i * stride + 1]! * scale,
          array[i * stride + 2]! * scale,
          array[i * stride + 3]! * scale,
        ).normalize();
      }
      if (scaled) read3(scaled, i, s);
      else s.set(1, 1, 1);
      this.add_instance(
        matrix.clone().multiply(new Matrix4().compose(t, q, s)),
        element,
        ids ? ids.array[i * ids.stride]! : NO_FEATURE,
      );
    }
  }

  private add_instance(matrix: Matrix4, element: number, feature: number): void {
    this.matrices.push(matrix);
    this.element_of.push(element);
    this.feature_of.push(feature);
  }

  private element_number(mesh: number): number {
    let number = this.numbers.get(mesh);
    if (number === undefined) this.numbers.set(mesh, (number = this.elements.push(this.glb.json.meshes[mesh]) - 1));
    return number;
  }

  private make_cells(): void {
    if (!this.matrices.length) return;
    for (let view = 0; view < (this.glb.json.bufferViews?.length ?? 0); ++view)
      this.source_bytes += this.glb.view(view).length;
    const places = new Map<string, number[]>();
    this.matrices.forEach((matrix, instance) => {
      const key = `${Math.floor(matrix.elements[12]! / CELL)} ${Math.floor(matrix.elements[14]! / CELL)}`;
      const there = places.get(key);
      if (there) there.push(instance);
      else places.set(key, [instance]);
    });
    const in_pieces = (element: Json) => {
      const material: Json | undefined = this.glb.json.materials?.[element.primitives[0]?.material];
      return material?.extras?.classes !== undefined;
    };
    const shapes = this.elements.map((element) => coarser(this.shape(element), in_pieces(element)));
    for (const instances of places.values()) {
      const coarse = this.detail_mesh(instances, (element) => shapes[element]!);
      this.group.add(coarse);
      this.cells.push({ tile: this, instances, coarse, whole: null });
    }
  }

  private detail_mesh(instances: number[], shape_of: (element: number) => Shape): Mesh {
    let vertices = 0,
      corners = 0;
    for (const instance of instances) {
      const shape = shape_of(this.element_of[instance]!);
      vertices += shape.positions.length / 3;
      corners += shape.index.length;
    }
    const out = new Vertices(vertices);
    const index = vertices > 65535 ? new Uint32Array(corners) : new Uint16Array(corners);
    const normal_matrix = new Matrix3(),
      p = new Vector3(),
      n = new Vector3();
    let corner = 0;
    for (const instance of instances) {
      const shape = shape_of(this.element_of[instance]!);
      const matrix = this.matrices[instance]!,
        row = this.feature_of[instance]!;
      normal_matrix.getNormalMatrix(matrix);
      const first = out.count;
      for (let v = 0; v < shape.positions.length; v += 3) {
        p.set(shape.positions[v]!, shape.positions[v + 1]!, shape.positions[v + 2]!).applyMatrix4(matrix);
        n.set(shape.normals[v]!, shape.normals[v + 1]!, shape.normals[v + 2]!)
          .applyMatrix3(normal_matrix)
          .normalize();
        const at = out.add(p, n, row);
        out.features[2 * at + 1] = this.above_foot(row, p.y);
      }
      out.paint.set(shape.paint, 4 * first);
      const mirrored = matrix.determinant() < 0;
      for (let i = 0; i < shape.index.length; i += 3) {
        index[corner++] = first + shape.index[i]!;
        index[corner++] = first + shape.index[i + (mirrored ? 2 : 1)]!;
        index[corner++] = first + shape.index[i + (mirrored ? 1 : 2)]!;
      }
    }
    const mesh = new Mesh(out.geometry(index), this.material);
    mesh.receiveShadow = mesh.castShadow = true;
    mesh.userData.model = this;
    return mesh;
  }

  /** An element with its materials as paint, in its own frame; of vertices that its materials share, those that each uses. */
  private shape(element: Json): Shape {
    const positions: number[] = [],
      normals: number[] = [],
      paint: number[] = [],
      index: number[] = [];
    const p = new Vector3(),
      n = new Vector3(0, 0, 1);
    const texel = new Uint8Array(4);
    for (const primitive of element.primitives) {
      const from = this.glb.values(primitive.attributes.POSITION);
      const facing = primitive.attributes.NORMAL === undefined ? null : this.glb.values(primitive.attributes.NORMAL);
      const colours = primitive.attributes.COLOR_0 === undefined ? null : this.glb.values(primitive.attributes.COLOR_0);
      const corners = primitive.indices === undefined ? null : this.glb.values(primitive.indices);
      const paint_vertex = painter(this.glb, primitive, colours, KIND.detail);
      const copies = new Int32Array(from.count).fill(-1);
      const count = corners ? corners.count : from.count;
      for (let i = 0; i < count; ++i) {
        const v = corners ? corners.array[i * corners.stride]! : i;
        if (copies[v]! < 0) {
          copies[v] = positions.length / 3;
          read3(from, v, p);
          if (facing) read3(facing, v, n);
          positions.push(p.x, p.y, p.z);
          normals.push(n.x, n.y, n.z);
          paint_vertex(v, texel, 0);
          paint.push(texel[0]!, texel[1]!, texel[2]!, texel[3]!);
        }
        index.push(copies[v]!);
      }
    }
    return {
      positions: new Float32Array(positions),
      normals: new Float32Array(normals),
      paint: new Uint8Array(paint),
      index: new Uint32Array(index),
    };
  }
}

/** Vertices as they are drawn: 24 bytes each. */
class Vertices {
  readonly positions: Float32Array;
  readonly normals: Int8Array;
  readonly paint: Uint8Array;
  readonly features: Uint16Array;
  count = 0;

  constructor(capacity: number) {
    this.positions = new Float32Array(3 * capacity);
    this.normals = new Int8Array(4 * capacity);
    this.paint = new Uint8Array(4 * capacity);
    this.features = new Uint16Array(2 * capacity);
  }

  add(p: Vector3, n: Vector3, feature: number): number {
    const at = this.count++;
    this.positions[3 * at] = p.x;
    this.positions[3 * at + 1] = p.y;
    this.positions[3 * at + 2] = p.z;
    this.normals[4 * at] = Math.round(127 * n.x);
    this.normals[4 * at + 1] = Math.round(127 * n.y);
    this.normals[4 * at + 2] = Math.round(127 * n.z);
    this.features[2 * at] = feature;
    return at;
  }

  geometry(index: Uint16Array | Uint32Array): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(this.positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(this.normals, 4, true));
    geometry.setAttribute('paint', new BufferAttribute(this.paint, 4, true));
    geometry.setAttribute('feature', new BufferAttribute(this.features, 2));
    geometry.setIndex(new BufferAttribute(index, 1));
    geometry.computeBoundingSphere();
    return geometry;
  }
}

/** Writes a vertex's colour: square roots of linear light, which keep dark tones in eight bits, and the kind. */
function painter(
  glb: Glb,
  primitive: Json,
  colours: Values | null,
  kind: number,
): (v: number, into: Uint8Array, at: number) => void {
  const material: Json = glb.json.materials?.[primitive.material] ?? {};
  const base: number[] = material.pbrMetallicRoughness?.baseColorFactor ?? [1, 1, 1, 1];
  const shown = (name: unknown): number =>
    name === 'glass' ? KIND.glass : name === 'metal' && kind === KIND.detail ? KIND.metal : kind;
  // Tiles have one material for all classes, which vertices look up in a picture of one row: 1, 2, 4 … pixels wide.
  const classes: string[] | undefined = material.extras?.classes;
  const places =
    classes && primitive.attributes.TEXCOORD_0 !== undefined ? glb.values(primitive.attributes.TEXCOORD_0) : null;
  const width = 2 ** Math.ceil(Math.log2(Math.max(1, classes?.length ?? 1)));
  const kinds = (classes ?? []).map(shown);
  const one = shown(material.name);
  return (v, into, at) => {
    for (let c = 0; c < 3; ++c) {
      const own = colours ? colours.array[v * colours.stride + c]! * colours.scale : 1;
      into[at + c] = Math.round(255 * Math.sqrt(Math.min(1, base[c]! * own)));
    }
    into[at + 3] = places ? (kinds[Math.floor(places.array[v * places.stride]! * places.scale * width)] ?? kind) : one;
  };
}

function read3(values: Values, index: number, into: Vector3): Vector3 {
  const at = index * values.stride,
    { array, scale } = values;
  return into.set(array[at]! * scale, array[at + 1]! * scale, array[at + 2]! * scale);
}

/** The largest triangles of a shape, which are what is seen of it from afar. A piece lies about its own middle, and its
 * element's reveal is another piece. */
function coarser(shape: Shape, piece: boolean): Shape {
  const count = shape.index.length / 3;
  if (count <= COARSE_TRIANGLES) return shape;
  const a = new Vector3(),
    b = new Vector3(),
    c = new Vector3();
  const corner = (i: number, into: Vector3) => into.fromArray(shape.positions, 3 * shape.index[i]!);
  const areas = new Float32Array(count);
  let total = 0;
  for (let t = 0; t < count; ++t) {
    corner(3 * t, a);
    areas[t] = corner(3 * t + 1, b)
      .sub(a)
      .cross(corner(3 * t + 2, c).sub(a))
      .length();
    total += areas[t]!;
  }
  const order = Array.from(areas.keys()).sort((x, y) => areas[y]! - areas[x]!);
  const index: number[] = [],
    kept: number[] = [],
    copies = new Map<number, number>();
  let covered = 0;
  for (const t of order.slice(0, COARSE_TRIANGLES)) {
    for (let i = 3 * t; i < 3 * t + 3; ++i) {
      const v = shape.index[i]!;
      if (!copies.has(v)) copies.set(v, kept.push(v) - 1);
      index.push(copies.get(v)!);
    }
    covered += areas[t]!;
    if (covered > COARSE_SHARE * total) break;
  }
  const pick = <T extends Float32Array | Uint8Array>(from: T, size: number, into: T): T => {
    kept.forEach((v, i) => into.set(from.subarray(v * size, v * size + size) as never, i * size));
    return into;
  };
  if (piece && !shape.paint.some((value, i) => i % 4 === 3 && value === KIND.glass)) return without_back();
  return backed(shape, order, without_back(), piece);

  function without_back(): Shape {
    return {
    positions: pick(shape.positions, 3, new Float32Array(3 * kept.length)),
    normals: pick(shape.normals, 3, new Float32Array(3 * kept.length)),
    paint: pick(shape.paint, 4, new Uint8Array(4 * kept.length)),
    index: new Uint32Array(index),
    };
  }
}

/** Frames and reveals that are left out would be holes through the house: behind an opening lies a plane in the colour
 * of its frame, wider than the opening by its depth, so that a slanting look meets it as well. The wall hides the rest of it. */
function backed(shape: Shape, largest_first: number[], coarse: Shape, piece: boolean): Shape {
  let depth = 0;
  for (let v = 2; v < shape.positions.length; v += 3) depth = Math.min(depth, shape.positions[v]!);
  if (depth > -0.01) return coarse; // m: it stands on the wall, not in it
  let [west, east, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let v = 0; v < shape.positions.length; v += 3) {
    if (!piece && shape.positions[v + 2]! > -0.005) continue;
    west = Math.min(west, shape.positions[v]!);
    east = Math.max(east, shape.positions[v]!);
    low = Math.min(low, shape.positions[v + 1]!);
    high = Math.max(high, shape.positions[v + 1]!);
  }
  const of_frame = largest_first.map((t) => shape.index[3 * t]!).find((v) => shape.paint[4 * v + 3] === KIND.detail);
  const colour = of_frame === undefined ? [110, 110, 110, KIND.detail] : Array.from(shape.paint.subarray(4 * of_frame, 4 * of_frame + 4));
  const z = piece ? 1.02 * depth : depth - 0.01,
    first = coarse.positions.length / 3;
  if (!piece) (west += depth), (east -= depth), (low += depth), (high -= depth);
  return {
    positions: Float32Array.of(...coarse.positions, west, low, z, east, low, z, east, high, z, west, high, z),
    normals: Float32Array.of(...coarse.normals, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1),
    paint: Uint8Array.of(...coarse.paint, ...colour, ...colour, ...colour, ...colour),
    index: Uint32Array.of(...coarse.index, first, first + 1, first + 2, first, first + 2, first + 3),
  };
}
