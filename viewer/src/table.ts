// The property table of a tile (EXT_structural_metadata): what is known of each building part. Values are read when
// asked for.
import type { Glb, Json } from './glb';

export type Value = string | number | boolean;

export class Table {
  readonly count: number;
  readonly names: string[];
  private readonly schema: Json;
  private readonly described: Json;
  private readonly columns: Json;
  private readonly decoder = new TextDecoder();

  constructor(private readonly glb: Glb) {
    const metadata: Json = glb.json.extensions?.EXT_structural_metadata ?? {};
    const table: Json = metadata.propertyTables?.[0] ?? { count: 0, properties: {} };
    this.schema = metadata.schema ?? {};
    this.count = table.count;
    this.columns = table.properties ?? {};
    this.described = this.schema.classes?.[table.class]?.properties ?? {};
    this.names = Object.keys(this.columns);
  }

  /** undefined: no such column, or no value in this row. */
  get(name: string, row: number): Value | undefined {
    const column = this.columns[name],
      kind = this.described[name];
    if (!column || !kind || row < 0 || row >= this.count) return undefined;
    if (kind.type === 'STRING') {
      const offsets = this.glb.view(column.stringOffsets);
      const at = (i: number) => number_at(offsets, i, column.stringOffsetType ?? 'UINT32');
      const text = this.decoder.decode(this.glb.view(column.values).subarray(at(row), at(row + 1)));
      return text === kind.noData ? undefined : text;
    }
    const values = this.glb.view(column.values);
    if (kind.type === 'BOOLEAN') return ((values[row >> 3] ?? 0) >> (row & 7)) % 2 === 1;
    if (kind.type === 'ENUM') {
      const meaning = this.schema.enums?.[kind.enumType];
      const value = number_at(values, row, meaning?.valueType ?? 'UINT16');
      const found = meaning?.values?.find((v: Json) => v.value === value)?.name;
      return found === kind.noData ? undefined : found;
    }
    if (kind.type !== 'SCALAR') return undefined;
    const value = number_at(values, row, kind.componentType);
    return value === kind.noData ? undefined : value;
  }

  text(name: string, row: number): string {
    const value = this.get(name, row);
    return value === undefined ? '' : String(value);
  }

  /** All values of a row in the table's order. */
  row(row: number): [string, Value][] {
    const all: [string, Value][] = [];
    for (const name of this.names) {
      const value = this.get(name, row);
      if (value !== undefined) all.push([name, value]);
    }
    return all;
  }
}

/** {attribute: source} of the column `sources`, "tag: use, storeys; implied: height". */
export function sources_of(text: string): Map<string, string> {
  const found = new Map<string, string>();
  for (const group of text.split('; ')) {
    const [source, names] = group.split(': ');
    for (const name of names?.split(', ') ?? []) found.set(name, source ?? '');
  }
  return found;
}

function number_at(bytes: Uint8Array, index: number, type: string): number {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  switch (type) {
    case 'UINT8':
      return view.getUint8(index);
    case 'INT8':
      return view.getInt8(index);
    case 'UINT16':
      return view.getUint16(2 * index, true);
    case 'INT16':
      return view.getInt16(2 * index, true);
    case 'UINT32':
      return view.getUint32(4 * index, true);
    case 'INT32':
      return view.getInt32(4 * index, true);
    case 'UINT64':
      return Number(view.getBigUint64(8 * index, true));
    case 'INT64':
      return Number(view.getBigInt64(8 * index, true));
    case 'FLOAT32':
      return view.getFloat32(4 * index, true);
    case 'FLOAT64':
      return view.getFloat64(8 * index, true);
    default:
      throw new Error(`has a column of type ${type}`);
  }
}
