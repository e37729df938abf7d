// Addresses, names and ids of all buildings, for the search. Loaded at the first search: a city has some 20 MB of them.
import type { Files } from './files';

export interface PlaceLine {
  id: string;
  tile: string;
  lon: number;
  lat: number;
  height: number;
  address: string;
  name: string;
}

export class Places {
  private lines: string[] = [];
  private folded: string[] = [];
  private loading: Promise<void> | null = null;

  constructor(
    private readonly files: Files,
    private readonly paths: string[],
  ) {}

  get count(): number {
    return this.lines.length;
  }

  /** Rejects with what could not be loaded; may be tried again. */
  load(): Promise<void> {
    this.loading ??= this.read().catch((error: unknown) => {
      this.loading = null;
      throw error;
    });
    return this.loading;
  }

  private async read(): Promise<void> {
    const texts = await Promise.all(this.paths.map((path) => this.files.text(path)));
    this.lines = texts.flatMap((text) => text.split('\n').filter((line) => line.includes('\t')));
    this.folded = this.lines.map((line) => {
      const [id = '', , , , , address = '', name = ''] = line.split('\t');
      return `${id}\t${fold(address)}\t${fold(name)}`;
    });
  }

  /** The best hits first: the id itself, then beginnings, then what contains all words. */
  find(query: string, most: number): { hits: PlaceLine[]; all: number } {
    const folded = fold(query.trim()),
      words = folded.split(/[\s,]+/).filter(Boolean);
    const ranked: [number, number][] = [];
    if (words.length) {
      this.folded.forEach((line, i) => {
        if (!words.every((word) => line.includes(word))) return;
        const [id = '', address = '', name = ''] = line.split('\t');
        ranked.push([
          id === folded ? 0 : address.startsWith(folded) || name.startsWith(folded) ? 1 : id.startsWith(folded) ? 2 : 3,
          i,
        ]);
      });
    }
    ranked.sort((a, b) => a[0] - b[0] || this.lines[a[1]]!.length - this.lines[b[1]]!.length || a[1] - b[1]);
    return { hits: ranked.slice(0, most).map(([, i]) => place_of(this.lines[i]!)), all: ranked.length };
  }

  by_id(id: string): PlaceLine | null {
    const line = this.lines.find((candidate) => candidate.startsWith(`${id}\t`));
    return line ? place_of(line) : null;
  }
}

function place_of(line: string): PlaceLine {
  const [id = '', tile = '', lon = '', lat = '', height = '', address = '', name = ''] = line
    .replace(/\r$/, '')
    .split('\t');
  return { id, tile, lon: Number(lon), lat: Number(lat), height: Number(height) || 0, address, name };
}

/** For comparison: no case, no accents, "straße", "strasse" and "str." the same. */
export function fold(text: string): string {
  return text
    .toLowerCase()
    .normalize('NFD')
    .replace(/\p{M}/gu, '')
    .replaceAll('ß', 'ss')
    .replace(/str(\.|(?=\s|$|\d))/g, 'strasse');
}
