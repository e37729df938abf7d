// Reads a GLB of a tile into typed arrays. GLTFLoader makes an object of each primitive, thousands in a tile with
// windows; here they stay arrays, and tile_model.ts makes few meshes of them.
import { Matrix4, Quaternion, Vector3 } from 'three';

export interface Json {
  [key: string]: any; // glTF as it was written; what is used of it is checked where it is used
}

/** Values of an accessor: value c of element i is array[i * stride + c] * scale. */
export interface Values {
  array: Float32Array | Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array;
  stride: number;
  count: number;
  size: number;
  scale: number;
}

const COMPONENTS = {
  5120: { make: Int8Array, largest: 127 },
  5121: { make: Uint8Array, largest: 255 },
  5122: { make: Int16Array, largest: 32767 },
  5123: { make: Uint16Array, largest: 65535 },
  5125: { make: Uint32Array, largest: 4294967295 },
  5126: { make: Float32Array, largest: 1 },
} as const;
const SIZES: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

export class Glb {
  private constructor(
    readonly json: Json,
    private readonly views: Uint8Array<ArrayBuffer>[],
  ) {}

  /** Throws an error with the reason where the bytes are no GLB that can be shown. */
  static async read(file: ArrayBuffer): Promise<Glb> {
    const head = new DataView(file);
    if (file.byteLength < 20 || head.getUint32(0, true) !== 0x46546c67) throw new Error('is no GLB');
    const json_bytes = head.getUint32(12, true);
    const json: Json = JSON.parse(new TextDecoder().decode(new Uint8Array(file, 20, json_bytes)));
    const start = 20 + json_bytes + 8;
    const bin = start <= file.byteLength ? new Uint8Array(file, start) : new Uint8Array(0);
    const views: Uint8Array<ArrayBuffer>[] = [];
    for (const view of json.bufferViews ?? []) {
      const packed = view.extensions?.EXT_meshopt_compression ?? view.extensions?.KHR_meshopt_compression;
      const from = packed ?? view;
      const bytes = bin.subarray(from.byteOffset ?? 0, (from.byteOffset ?? 0) + from.byteLength);
      views.push(packed ? await unpacked(bytes, packed) : bytes);
    }
    return new Glb(json, views);
  }

  view(index: number): Uint8Array<ArrayBuffer> {
    const view = this.views[index];
    if (!view) throw new Error(`has no buffer view ${index}`);
    return view;
  }

  values(index: number): Values {
    const accessor = this.json.accessors[index];
    const component = COMPONENTS[accessor.componentType as keyof typeof COMPONENTS];
    const size = SIZES[accessor.type];
    if (!component || !size) throw new Error(`has an accessor of type ${accessor.type}`);
    const width = component.make.BYTES_PER_ELEMENT;
    const described = this.json.bufferViews[accessor.bufferView];
    const stride =
      (described.extensions?.EXT_meshopt_compression?.byteStride ?? described.byteStride ?? size * width) / width;
    let bytes = this.view(accessor.bufferView);
    let offset = bytes.byteOffset + (accessor.byteOffset ?? 0);
    if (offset % width) {
      bytes = bytes.slice();
      offset = accessor.byteOffset ?? 0;
    }
    const length = Math.min(
      accessor.count * stride,
      Math.floor((bytes.byteOffset + bytes.byteLength - offset) / width),
    );
    return {
      array: new component.make(bytes.buffer, offset, length),
      stride,
      count: accessor.count,
      size,
      scale: accessor.normalized ? 1 / component.largest : 1,
    };
  }

  /** Each node that shows a mesh, with its matrix in the tile's frame. */
  *placed_nodes(): Generator<{ node: Json; matrix: Matrix4 }> {
    const nodes: Json[] = this.json.nodes ?? [];
    const scene = this.json.scenes?.[this.json.scene ?? 0];
    const open: [number, Matrix4][] = (scene?.nodes ?? nodes.keys()).map?.((n: number) => [n, new Matrix4()]) ?? [];
    for (let next = open.pop(); next; next = open.pop()) {
      const node = nodes[next[0]];
      if (!node) continue;
      const matrix = next[1].clone().multiply(own_matrix(node));
      for (const child of node.children ?? []) open.push([child, matrix]);
      if (node.mesh !== undefined) yield { node, matrix };
    }
  }
}

function own_matrix(node: Json): Matrix4 {
  if (node.matrix) return new Matrix4().fromArray(node.matrix);
  return new Matrix4().compose(
    new Vector3().fromArray(node.translation ?? [0, 0, 0]),
    new Quaternion().fromArray(node.rotation ?? [0, 0, 0, 1]),
    new Vector3().fromArray(node.scale ?? [1, 1, 1]),
  );
}

async function unpacked(bytes: Uint8Array, packed: Json): Promise<Uint8Array<ArrayBuffer>> {
  const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
  await MeshoptDecoder.ready;
  const out = new Uint8Array(packed.count * packed.byteStride);
  MeshoptDecoder.decodeGltfBuffer(out, packed.count, packed.byteStride, bytes, packed.mode, packed.filter ?? 'NONE');
  return out;
}
