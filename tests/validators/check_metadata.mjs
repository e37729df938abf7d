// EXT_mesh_features, EXT_structural_metadata, EXT_mesh_gpu_instancing and Blockrand's georeference, which the Khronos
// validator does not know.
//   node check_metadata.mjs [--tileset tileset.json] PATH...
// With --tileset also: each tile's georeference says what the tileset's transform says.
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';
import { Report, IDENTITY, each_primitive, enu_to_ecef, files_below, multiply, open_glb, read_accessor } from './glb.mjs';

const ID = /^[a-zA-Z_][a-zA-Z0-9_]*$/;
const SIZES = { INT8: 1, UINT8: 1, INT16: 2, UINT16: 2, INT32: 4, UINT32: 4, INT64: 8, UINT64: 8, FLOAT32: 4, FLOAT64: 8 };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
const report = new Report('check_metadata');
let files = 0;
let rows = 0;

/** The bytes of a buffer view, or null after saying why not. */
function view_bytes({ json, bin }, index, alignment, where) {
  const view = json.bufferViews?.[index];
  if (!view) return report.error(where, `buffer view ${index} does not exist`), null;
  const offset = view.byteOffset ?? 0;
  if (offset % alignment !== 0) report.error(where, `buffer view ${index} starts at ${offset}, not at a multiple of ${alignment}`);
  if (view.buffer !== 0 || offset + view.byteLength > bin.length) return report.error(where, `buffer view ${index} leaves the buffer`), null;
  return bin.subarray(offset, offset + view.byteLength);
}

function read_number(bytes, type, i) {
  const d = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  switch (type) {
    case 'INT8': return d.getInt8(i);
    case 'UINT8': return d.getUint8(i);
    case 'INT16': return d.getInt16(i * 2, true);
    case 'UINT16': return d.getUint16(i * 2, true);
    case 'INT32': return d.getInt32(i * 4, true);
    case 'UINT32': return d.getUint32(i * 4, true);
    case 'INT64': return d.getBigInt64(i * 8, true);
    case 'UINT64': return d.getBigUint64(i * 8, true);
    case 'FLOAT32': return d.getFloat32(i * 4, true);
    default: return d.getFloat64(i * 8, true);
  }
}

function check_schema(schema, where) {
  if (!schema) return report.error(where, 'no schema');
  if (!ID.test(schema.id ?? '')) report.error(where, 'schema.id is no identifier');
  for (const [id, e] of Object.entries(schema.enums ?? {})) {
    if (!ID.test(id)) report.error(where, `enum ${id} is no identifier`);
    const names = new Set(e.values.map((v) => v.name));
    const values = new Set(e.values.map((v) => v.value));
    if (names.size !== e.values.length || values.size !== e.values.length) report.error(where, `enum ${id} has a name or value twice`);
    const type = e.valueType ?? 'UINT16';
    const bits = SIZES[type] * 8;
    for (const v of values)
      if (!Number.isInteger(v) || (type.startsWith('U') ? v < 0 || v >= 2 ** bits : Math.abs(v) > 2 ** (bits - 1)))
        report.error(where, `enum ${id}: ${v} does not fit ${type}`);
  }
  for (const [id, c] of Object.entries(schema.classes ?? {})) {
    if (!ID.test(id)) report.error(where, `class ${id} is no identifier`);
    for (const [name, p] of Object.entries(c.properties ?? {})) {
      const at = `${where} ${id}.${name}`;
      if (!ID.test(name)) report.error(at, 'is no identifier');
      if (p.type === 'ENUM') {
        const e = schema.enums?.[p.enumType];
        if (!e) report.error(at, `enumType ${p.enumType} does not exist`);
        else if (p.noData !== undefined && !e.values.some((v) => v.name === p.noData)) report.error(at, `noData ${p.noData} is not in the enum`);
      } else if (p.type in WIDTHS) {
        if (!(p.componentType in SIZES)) report.error(at, `componentType ${p.componentType}`);
        if (p.normalized && !/INT/.test(p.componentType)) report.error(at, 'normalized floats');
        if (p.noData !== undefined && typeof p.noData !== 'number') report.error(at, 'noData is no number');
      } else if (p.type === 'STRING') {
        if (p.componentType || p.enumType || p.normalized) report.error(at, 'a STRING has no component type');
        if (p.noData !== undefined && typeof p.noData !== 'string') report.error(at, 'noData is no string');
      } else if (p.type !== 'BOOLEAN') report.error(at, `type ${p.type}`);
      if (p.required && (p.noData !== undefined || p.default !== undefined)) report.error(at, 'required together with noData or default');
    }
  }
}

/** Checks a column and returns its values, noData as null. */
function check_column(glb, schema, property, column, count, where) {
  if (property.type === 'STRING') {
    const type = column.stringOffsetType ?? 'UINT32';
    if (!['UINT8', 'UINT16', 'UINT32', 'UINT64'].includes(type)) return report.error(where, `stringOffsetType ${type}`);
    const text = view_bytes(glb, column.values, 1, where);
    const offsets = view_bytes(glb, column.stringOffsets, SIZES[type], where);
    if (!text || !offsets) return;
    if (offsets.length !== (count + 1) * SIZES[type]) return report.error(where, `${offsets.length} bytes of offsets for ${count} rows`);
    const out = [];
    let last = Number(read_number(offsets, type, 0));
    if (last !== 0) report.error(where, 'the first offset is not 0');
    for (let i = 1; i <= count; ++i) {
      const next = Number(read_number(offsets, type, i));
      if (next < last || next > text.length) return report.error(where, `offset ${i} (${next}) is out of order or beyond the text`);
      try {
        const value = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(text.subarray(last, next));
        out.push(value === property.noData ? null : value);
      } catch {
        report.error(where, `row ${i - 1} is not UTF-8`);
        out.push(null);
      }
      last = next;
    }
    if (last !== text.length) report.error(where, `${text.length - last} bytes behind the last text`);
    return out;
  }
  const is_enum = property.type === 'ENUM';
  const entry = is_enum ? schema.enums?.[property.enumType] : null;
  if (is_enum && !entry) return;
  const component = is_enum ? (entry.valueType ?? 'UINT16') : property.componentType;
  const width = is_enum ? 1 : WIDTHS[property.type];
  const bytes = view_bytes(glb, column.values, SIZES[component], where);
  if (!bytes) return;
  if (bytes.length !== count * width * SIZES[component]) return report.error(where, `${bytes.length} bytes for ${count} rows`);
  const out = [];
  for (let i = 0; i < count * width; ++i) {
    const value = read_number(bytes, component, i);
    if (is_enum) {
      const found = entry.values.find((v) => v.value === Number(value));
      if (!found) report.error(where, `row ${i}: ${value} is not in the enum`);
      out.push(found?.name === property.noData && property.noData !== undefined ? null : found?.name);
    } else {
      if (typeof value === 'number' && !Number.isFinite(value)) report.error(where, `row ${i}: ${value}`);
      out.push(Number(value) === property.noData ? null : value);
    }
  }
  return out;
}

function check_table(glb, schema, table, where) {
  const definition = schema?.classes?.[table.class];
  if (!definition) return report.error(where, `class ${table.class} does not exist`);
  if (!Number.isInteger(table.count) || table.count < 1) return report.error(where, `count ${table.count}`);
  rows += table.count;
  const columns = {};
  for (const [name, property] of Object.entries(definition.properties ?? {}))
    if (property.required && !table.properties?.[name]) report.error(where, `required column ${name} is missing`);
  for (const [name, column] of Object.entries(table.properties ?? {})) {
    const property = definition.properties?.[name];
    if (!property) report.error(where, `column ${name} is not in the class`);
    else columns[name] = check_column(glb, schema, property, column, table.count, `${where} ${name}`);
  }
  // What Blockrand promises about its own class.
  if (table.class === 'building_part') {
    const ids = columns.id ?? [];
    if (new Set(ids).size !== ids.length) report.error(where, 'two rows have one id');
    ids.forEach((id, i) => {
      const building = columns.building?.[i];
      if (!/^[nwr]-?\d+(\.([nwr]-?\d+|rest|\d+))*$/.test(id ?? '')) report.error(where, `row ${i}: id ${id}`);
      if (building && id !== building && !id?.startsWith(building + '.')) report.error(where, `row ${i}: ${id} does not belong to ${building}`);
    });
    for (const name of ['tags', 'building_tags', 'evidence'])
      (columns[name] ?? []).forEach((text, i) => {
        try {
          if (text !== null && typeof JSON.parse(text) !== 'object') throw new Error('no object');
        } catch {
          report.error(where, `row ${i}: ${name} is no JSON object`);
        }
      });
    (columns.sources ?? []).forEach((text, i) => {
      if (text !== null && !/^\w+: \w+(, \w+)*(; \w+: \w+(, \w+)*)*$/.test(text)) report.error(where, `row ${i}: sources ${text}`);
    });
    for (const [name, property] of Object.entries(definition.properties))
      if (name.endsWith('_source') && property.enumType !== 'Source') report.error(where, `${name} is no Source`);
  }
}

function check_features(glb, where) {
  const { json } = glb;
  const tables = json.extensions?.EXT_structural_metadata?.propertyTables ?? [];
  each_primitive(glb, (primitive, _matrix, node) => {
    const count = json.accessors[primitive.attributes.POSITION].count;
    for (const id of primitive.extensions?.EXT_mesh_features?.featureIds ?? []) {
      if (!Number.isInteger(id.featureCount) || id.featureCount < 1) report.error(where, `featureCount ${id.featureCount}`);
      if (id.propertyTable !== undefined && !tables[id.propertyTable]) report.error(where, `property table ${id.propertyTable} does not exist`);
      const limit = tables[id.propertyTable]?.count ?? Infinity;
      if (id.attribute === undefined) continue;
      const accessor = primitive.attributes[`_FEATURE_ID_${id.attribute}`];
      if (accessor === undefined) {
        report.error(where, `_FEATURE_ID_${id.attribute} does not exist`);
        continue;
      }
      const a = json.accessors[accessor];
      if (a.type !== 'SCALAR' || a.normalized) report.error(where, 'feature ids are plain scalars');
      if (a.count !== count) report.error(where, `${a.count} feature ids for ${count} vertices`);
      const values = read_accessor(glb, accessor);
      const different = new Set();
      for (const v of values) {
        if (!Number.isInteger(v) || v < 0 || v >= limit) {
          report.error(where, `feature id ${v} in a table of ${limit} rows`);
          break;
        }
        different.add(v);
      }
      if (different.size > id.featureCount) report.error(where, `${different.size} different features, featureCount ${id.featureCount}`);
      // A triangle whose corners belong to two features could be picked as neither.
      if (primitive.indices !== undefined) {
        const index = read_accessor(glb, primitive.indices);
        for (let i = 0; i + 2 < index.length; i += 3)
          if (values[index[i]] !== values[index[i + 1]] || values[index[i]] !== values[index[i + 2]]) {
            report.error(where, `triangle ${i / 3} belongs to two features`);
            break;
          }
      }
    }
    const instancing = node.extensions?.EXT_mesh_gpu_instancing;
    if (instancing) {
      const counts = Object.values(instancing.attributes ?? {}).map((a) => json.accessors[a]?.count);
      if (counts.length === 0 || counts.some((c) => c !== counts[0])) report.error(where, 'instance attributes differ in count');
    }
  });
}

function check_georeference(json, transform, where) {
  const g = json.asset?.extras?.georeference;
  if (!g) return report.error(where, 'no asset.extras.georeference');
  if (typeof g.crs !== 'string' || g.crs === '') report.error(where, 'georeference.crs is empty');
  if (typeof g.height_reference !== 'string' || g.height_reference === '') report.error(where, 'georeference.height_reference is empty');
  const m = g.local_to_ecef;
  if (!Array.isArray(m) || m.length !== 16 || !m.every(Number.isFinite)) return report.error(where, 'local_to_ecef is not 16 numbers');
  const { longitude, latitude, height } = g.origin ?? {};
  if (![longitude, latitude, height].every(Number.isFinite)) return report.error(where, 'origin is incomplete');
  const expected = enu_to_ecef((longitude * Math.PI) / 180, (latitude * Math.PI) / 180, height);
  const off = Math.max(...expected.map((v, i) => Math.abs(v - m[i]) / (i >= 12 ? 1 : 1e-6)));
  if (!(off < 1e-3)) report.error(where, 'local_to_ecef is not the frame of the origin');
  if (transform && transform.some((v, i) => v !== m[i])) report.error(where, "local_to_ecef is not the tileset's transform");
}

const args = process.argv.slice(2);
const flag = args.indexOf('--tileset');
const transforms = new Map();
if (flag >= 0) {
  const [path] = args.splice(flag, 2).slice(1);
  const walk = (tile, matrix) => {
    const own = tile.transform ? (matrix === IDENTITY ? tile.transform : multiply(matrix, tile.transform)) : matrix;
    if (tile.content) transforms.set(normalize(join(dirname(path), tile.content.uri)), own);
    for (const child of tile.children ?? []) walk(child, own);
  };
  walk(JSON.parse(readFileSync(path, 'utf8')).root, IDENTITY);
}
if (args.length === 0 || !args.every((a) => existsSync(a))) {
  console.error('usage: node check_metadata.mjs [--tileset tileset.json] PATH...');
  process.exit(2);
}
for (const file of args.flatMap((a) => files_below(a, ['.glb']))) {
  ++files;
  try {
    const glb = open_glb(readFileSync(file));
    const extension = glb.json.extensions?.EXT_structural_metadata;
    if (extension) {
      check_schema(extension.schema, file);
      (extension.propertyTables ?? []).forEach((t, i) => check_table(glb, extension.schema, t, `${file} table ${i}`));
    }
    for (const name of ['EXT_structural_metadata', 'EXT_mesh_features', 'KHR_mesh_quantization'])
      if (JSON.stringify(glb.json).includes(`"${name}":`) && !glb.json.extensionsUsed?.includes(name))
        report.error(file, `${name} is not in extensionsUsed`);
    check_features(glb, file);
    check_georeference(glb.json, transforms.get(normalize(file)), file);
  } catch (error) {
    report.error(file, error.stack.split('\n').slice(0, 2).join(' '));
  }
}
report.finish(`${files} files, ${rows} rows`);
