// Do the checks find what they are for? Damages a good build in many ways and asks each time.
//   node selftest.mjs FOLDER      (tileset.json and tiles/ of any build, for example of tests/unit/export/make_sample)
// The Khronos cases are skipped where gltf-validator is not installed.
import { spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { files_below, open_glb } from './glb.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const source = process.argv[2];
if (!source) {
  console.error('usage: node selftest.mjs FOLDER');
  process.exit(2);
}

function write_glb(path, json, bin) {
  const text = Buffer.from(JSON.stringify(json));
  const pad = (b, fill) => Buffer.concat([b, Buffer.alloc((4 - (b.length % 4)) % 4, fill)]);
  const [a, b] = [pad(text, 0x20), pad(bin, 0)];
  const header = Buffer.alloc(20);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(20 + a.length + 8 + b.length, 8);
  header.writeUInt32LE(a.length, 12);
  header.writeUInt32LE(0x4e4f534a, 16);
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(b.length, 0);
  chunk.writeUInt32LE(0x004e4942, 4);
  writeFileSync(path, Buffer.concat([header, a, chunk, b]));
}

const tileset = (change) => (folder) => {
  const path = join(folder, 'tileset.json');
  const json = JSON.parse(readFileSync(path, 'utf8'));
  change(json);
  writeFileSync(path, JSON.stringify(json));
};
/** Damages the first tile with content. */
const glb = (change) => (folder) => {
  const path = files_below(join(folder, 'tiles'), ['.glb'])[0];
  const { json, bin } = open_glb(readFileSync(path));
  const copy = Buffer.from(bin);
  change(json, copy);
  write_glb(path, json, copy);
};
const leaf = (tile) => (tile.children ? leaf(tile.children[0]) : tile);
const metadata = (json) => json.extensions.EXT_structural_metadata;
const table = (json) => metadata(json).propertyTables[0];
const properties = (json) => metadata(json).schema.classes[table(json).class].properties;
const view = (json, index) => json.bufferViews[index];
/** Where the indices of the first primitive begin in the binary chunk. */
const indices = (json) => {
  const accessor = json.accessors[primitive(json).indices];
  return view(json, accessor.bufferView).byteOffset + (accessor.byteOffset ?? 0);
};
const primitive = (json) => json.meshes[0].primitives[0];

const T = 'check_tileset.mjs';
const M = 'check_metadata.mjs';
const V = 'validate_gltf.mjs';
const cases = [
  [T, 'a wrong version', /asset.version/, tileset((t) => (t.asset.version = '1.0'))],
  [T, 'a child with a larger error', /above the parent/, tileset((t) => (t.root.children[0].geometricError = 1e9))],
  [T, 'a leaf with an error', /leaf has geometricError 0/, tileset((t) => (leaf(t.root).geometricError = 1))],
  [T, 'a negative error', /number >= 0/, tileset((t) => (leaf(t.root).geometricError = -1))],
  [T, 'a root without refine', /needs refine/, tileset((t) => delete t.root.refine)],
  [T, 'an unknown refine', /refine/, tileset((t) => (t.root.refine = 'replace'))],
  [T, 'a tileset error below the root', /below its root/, tileset((t) => (t.geometricError = 0))],
  [T, 'a uri that leads nowhere', /does not exist/, tileset((t) => (leaf(t.root).content.uri = 'tiles/none.glb'))],
  [T, 'an orphan tile', /used by no tile/, (f) => cpSync(files_below(join(f, 'tiles'), ['.glb'])[0], join(f, 'tiles', 'x.glb'))],
  [T, 'a scaled transform', /orthonormal/, tileset((t) => (leaf(t.root).transform[0] *= 1.001))],
  [T, 'a mirrored transform', /mirrors/, tileset((t) => { const m = leaf(t.root).transform; for (const i of [0, 1, 2]) m[i] *= -1; })],
  [T, 'a box that is too small', /outside the volume of its tile/, tileset((t) => (leaf(t.root).boundingVolume.box[3] *= 0.9))],
  [T, 'a box that is moved', /outside the volume of its tile/, tileset((t) => (leaf(t.root).boundingVolume.box[2] += 1))],
  [T, 'a box beyond its parent', /out of an ancestor/, tileset((t) => (leaf(t.root).boundingVolume.box[3] += 5000))],
  [T, 'a root region that is too small', /ancestor/, tileset((t) => (t.root.boundingVolume.region[5] = t.root.boundingVolume.region[4]))],
  [T, 'a transform to another place', /ancestor/, tileset((t) => (leaf(t.root).transform[12] += 1e5))],
  [T, 'two bounding volumes', /exactly one/, tileset((t) => (t.root.boundingVolume.sphere = [0, 0, 0, 1e8]))],
  [T, 'degrees for radians', /beyond the Earth/, tileset((t) => (t.root.boundingVolume.region = [13, 52, 14, 53, 0, 100]))],
  [T, 'geometry outside of its tile', /outside the volume/, glb((j) => (j.nodes[0].translation = [0, 100, 0]))],
  [T, 'a truncated tile', /length/, (f) => { const p = files_below(join(f, 'tiles'), ['.glb'])[0]; writeFileSync(p, readFileSync(p).subarray(0, 2000)); }],
  [M, 'feature ids beyond the table', /feature id/, glb((j, b) => { const a = j.accessors[primitive(j).attributes._FEATURE_ID_0]; b.writeUInt16LE(60000, (view(j, a.bufferView).byteOffset ?? 0) + (a.byteOffset ?? 0)); })],
  [M, 'a missing feature attribute', /does not exist/, glb((j) => delete primitive(j).attributes._FEATURE_ID_0)],
  [M, 'a missing property table', /property table 3/, glb((j) => (primitive(j).extensions.EXT_mesh_features.featureIds[0].propertyTable = 3))],
  [M, 'a too small featureCount', /different features/, glb((j) => (primitive(j).extensions.EXT_mesh_features.featureIds[0].featureCount = 1))],
  [M, 'a triangle across two features', /belongs to two features/, glb((j, b) => b.writeUInt16LE(j.accessors[primitive(j).attributes.POSITION].count - 1, indices(j)))],
  [M, 'a column that is too short', /bytes for/, glb((j) => (view(j, table(j).properties.height.values).byteLength -= 8))],
  [M, 'misaligned doubles', /multiple of 8/, glb((j) => (view(j, table(j).properties.height.values).byteOffset += 4))],
  [M, 'a NaN', /NaN/, glb((j, b) => b.writeDoubleLE(NaN, view(j, table(j).properties.height.values).byteOffset))],
  [M, 'string offsets out of order', /out of order/, glb((j, b) => b.writeUInt16LE(60000, view(j, table(j).properties.id.stringOffsets).byteOffset + 2))],
  [M, 'broken UTF-8', /not UTF-8/, glb((j, b) => (b[view(j, table(j).properties.use.values).byteOffset] = 0xff))],
  [M, 'an enum value that does not exist', /not in the enum/, glb((j, b) => (b[view(j, table(j).properties.height_source.values).byteOffset] = 99))],
  [M, 'an enum that does not exist', /enumType/, glb((j) => delete metadata(j).schema.enums.Source)],
  [M, 'a required column that is missing', /required column/, glb((j) => delete table(j).properties.id)],
  [M, 'required with noData', /together with noData/, glb((j) => (properties(j).id.noData = ''))],
  [M, 'a noData of the wrong type', /noData is no number/, glb((j) => (properties(j).height.noData = 'none'))],
  [M, 'a column without class property', /not in the class/, glb((j) => (table(j).properties.unknown = { values: 0 }))],
  [M, 'an id with a hyphen', /no identifier/, glb((j) => (properties(j)['a-b'] = { type: 'STRING' }))],
  [M, 'two rows with one id', /one id|does not belong|id /, glb((j, b) => { const v = view(j, table(j).properties.id.values).byteOffset; const o = view(j, table(j).properties.id.stringOffsets).byteOffset; const n = b.readUInt16LE(o + 2); b.copy(b, v + n, v, v + n); b.writeUInt16LE(2 * n, o + 4); })],
  [M, 'no georeference', /no asset.extras.georeference/, glb((j) => delete j.asset.extras)],
  [M, 'an origin elsewhere', /not the frame of the origin/, glb((j) => (j.asset.extras.georeference.origin.longitude += 0.001))],
  [M, 'a matrix other than the transform', /not the tileset's transform/, glb((j) => (j.asset.extras.georeference.local_to_ecef[12] += 1e-5))],
  [M, 'an extension that is not declared', /not in extensionsUsed/, glb((j) => (j.extensionsUsed = ['KHR_mesh_quantization']))],
  [V, 'an index beyond the vertices', /ACCESSOR_INDEX_OOB/, glb((j, b) => b.writeUInt16LE(65000, indices(j)))],
  [V, 'wrong bounds', /ACCESSOR_MAX_MISMATCH/, glb((j) => (j.accessors[primitive(j).attributes.POSITION].max[0] += 1))],
  [V, 'a version that does not exist', /VERSION/i, glb((j) => (j.asset.version = '9.0'))],
];

const run = (check, folder) => {
  const args = { [T]: [folder], [M]: ['--tileset', join(folder, 'tileset.json'), join(folder, 'tiles')], [V]: [join(folder, 'tiles')] }[check];
  const done = spawnSync(process.execPath, [join(here, check), ...args], { encoding: 'utf8' });
  return { status: done.status, text: done.stdout + done.stderr };
};
const work = mkdtempSync(join(tmpdir(), 'blockrand-selftest-'));
let failed = 0;
let skipped = 0;
try {
  const available = {};
  for (const check of [T, M, V]) {
    const { status, text } = run(check, source);
    available[check] = !/is not installed/.test(text);
    if (available[check] && status !== 0) {
      console.log(`FAILED: ${check} does not accept the good folder:\n${text}`);
      ++failed;
    }
  }
  for (const [check, name, expected, damage] of cases) {
    if (!available[check]) {
      ++skipped;
      continue;
    }
    const folder = join(work, 'case');
    rmSync(folder, { recursive: true, force: true });
    cpSync(source, folder, { recursive: true });
    damage(folder);
    const { status, text } = run(check, folder);
    if (status !== 1 || !expected.test(text)) {
      console.log(`FAILED: ${name}: ${check} ended with ${status}:\n${text}`);
      ++failed;
    }
  }
} finally {
  rmSync(work, { recursive: true, force: true });
}
console.log(`selftest: ${cases.length - skipped} planted errors, ${failed} not found, ${skipped} skipped`);
process.exit(failed > 0 ? 1 : 0);
