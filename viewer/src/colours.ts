// Ways to colour houses, each with its categories. Colours are told apart by all kinds of colour vision: Okabe and Ito,
// "Color Universal Design" (2008) for kinds; for numbers and times ramps from light to dark.
import { Color } from 'three';
import { sources_of, Table } from './table';
import { paint_texel } from './paint';
import type { TileModel } from './tile_model';

export type ModeName = 'built' | 'style' | 'era' | 'storeys' | 'storeys_source' | 'roof_source';

export interface Category {
  key: string;
  label: string;
  colour: Color;
}

interface Mode {
  name: ModeName;
  label: string;
  categories: Category[];
  /** The category's key of a row; '' where nothing is known. */
  key_of(table: Table, row: number): string;
}

const UNKNOWN: Category = { key: '', label: 'not known', colour: new Color('#c9c9c9') };

function categories(...given: [string, string, string][]): Category[] {
  return [...given.map(([key, label, colour]) => ({ key, label, colour: new Color(colour) })), UNKNOWN];
}

const SOURCES = categories(
  ['tag', 'mapped in OpenStreetMap', '#0072b2'],
  ['override', 'ordered by an override', '#000000'],
  ['imagery', 'seen in aerial images', '#cc79a7'],
  ['implied', 'follows from other values', '#56b4e9'],
  ['geometry', 'from the plan and surroundings', '#009e73'],
  ['neighbours', 'as tagged neighbours', '#f0e442'],
  ['region', 'usual in the region', '#e69f00'],
  ['preset', 'usual for the style', '#d55e00'],
  ['default', 'assumed', '#8c8c8c'],
);

export const MODES: Mode[] = [
  { name: 'built', label: 'As built', categories: [], key_of: () => '' },
  {
    name: 'style',
    label: 'Style',
    categories: categories(
      ['gruenderzeit', 'Gründerzeit', '#d55e00'],
      ['tenement', 'interwar and plain tenement', '#009e73'],
      ['modern', 'modern', '#56b4e9'],
      ['other', 'other', '#cc79a7'],
    ),
    key_of: (table, row) => table.text('style', row),
  },
  {
    name: 'era',
    label: 'Era',
    categories: categories(
      ['pre1840', 'before 1840', '#2b1055'],
      ['1840_1918', '1840 to 1918', '#8a3ba8'],
      ['1919_1945', '1919 to 1945', '#e58a5f'],
      ['post1945', 'since 1945', '#f7e8a4'],
    ),
    key_of: (table, row) => table.text('era', row),
  },
  {
    name: 'storeys',
    label: 'Storeys',
    categories: categories(
      ['1', '1', '#fdf3c0'],
      ['2', '2', '#d8d27f'],
      ['3', '3', '#a0b869'],
      ['4', '4', '#6a9d6c'],
      ['5', '5', '#3f8075'],
      ['6', '6', '#2a6078'],
      ['8', '7 and 8', '#274073'],
      ['9', '9 and more', '#1d1a4f'],
    ),
    key_of: (table, row) => {
      const storeys = table.get('storeys', row);
      if (typeof storeys !== 'number') return '';
      const whole = Math.max(1, Math.round(storeys));
      return whole <= 6 ? String(whole) : whole <= 8 ? '8' : '9';
    },
  },
  {
    name: 'storeys_source',
    label: 'Source of storeys',
    categories: SOURCES,
    key_of: (table, row) => sources_of(table.text('sources', row)).get('storeys') ?? '',
  },
  {
    name: 'roof_source',
    label: 'Source of roof shape',
    categories: SOURCES,
    key_of: (table, row) => sources_of(table.text('sources', row)).get('roof_shape') ?? '',
  },
];

export function mode_named(name: string | null): Mode {
  return MODES.find((mode) => mode.name === name) ?? MODES[0]!;
}

function category_of(mode: Mode, table: Table, row: number): Category {
  const key = mode.key_of(table, row);
  return mode.categories.find((category) => category.key === key) ?? UNKNOWN;
}

/** Colours a tile's houses; those of `chosen` stand out. */
export function paint_tile(model: TileModel, mode: Mode, chosen: string | null): void {
  const chosen_rows = new Set(chosen === null ? [] : (model.rows_of.get(chosen) ?? []));
  for (let row = 0; row < model.table.count; ++row)
    paint_texel(
      model.texels,
      row,
      mode.categories.length ? category_of(mode, model.table, row).colour : null,
      chosen_rows.has(row),
    );
  model.features.needsUpdate = true;
}

/** Buildings of each category in these tiles, a building as its first part. */
export function counts(models: Iterable<TileModel>, mode: Mode): Map<Category, number> {
  const found = new Map<Category, number>(),
    seen = new Set<string>();
  for (const model of models) {
    for (const [building, rows] of model.rows_of) {
      if (seen.has(building)) continue;
      seen.add(building);
      const category = category_of(mode, model.table, rows[0]!);
      found.set(category, (found.get(category) ?? 0) + 1);
    }
  }
  return found;
}

export type { Mode };
