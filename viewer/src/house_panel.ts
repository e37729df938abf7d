// The panel of the chosen house: what was explained about it, what the tile knows of it, and where to read on.
import { MODES } from './colours';
import type { Files } from './files';
import { icon, make, Page } from './page';
import { sources_of, Value } from './table';
import type { TileModel } from './tile_model';

interface Explanation {
  title?: string;
  lines?: string[];
}

const UNITS: Record<string, string> = { height: 'm', eaves_height: 'm', roof_height: 'm', roof_pitch: '°' };
// Told in the heading, or of no use to people.
const NOT_LISTED = new Set(['address', 'name', 'sources', 'id', 'building']);
const OSM_TYPES: Record<string, string> = { n: 'node', w: 'way', r: 'relation' };
const KEPT_TILES = 12;

export class HousePanel {
  on_close = (): void => {};
  on_visit = (): void => {};
  private readonly tiles = new Map<string, Promise<Record<string, Explanation>>>();
  private building: string | null = null;

  constructor(
    private readonly page: Page,
    private readonly files: Files,
    private readonly explained: string | null,
  ) {}

  close(): void {
    this.building = null;
    this.page.panel.hidden = true;
    this.page.panel.replaceChildren();
    this.page.root.classList.remove('bv-has-panel');
  }

  /** Before its tile is there. */
  wait_for(building: string, title: string): void {
    this.building = building;
    this.fill(building, title, '', [make('p', { class: 'bv-note' }, 'The house is being loaded.')]);
  }

  async show(building: string, model: TileModel, rows: number[]): Promise<void> {
    this.building = building;
    const { table } = model,
      row = rows[0]!;
    const address = table.text('address', row),
      name = table.text('name', row);
    const attributes = attribute_list(model, rows);
    this.fill(building, name || address || building, name ? address : '', [
      make('p', { class: 'bv-note' }, this.explained ? 'Reading the explanation.' : ''),
      attributes,
    ]);
    if (!this.explained) return this.fill(building, name || address || building, name ? address : '', [attributes]);
    let explanation: Explanation | undefined;
    let failure = '';
    try {
      explanation = (await this.explanations(model.name))[building];
    } catch (error) {
      failure = (error as Error).message;
    }
    if (this.building !== building) return;
    const lines = explanation?.lines ?? [];
    const title = explanation?.title ?? (name || address || building);
    const parts: HTMLElement[] = [];
    if (lines.length) parts.push(make('ul', { class: 'bv-lines' }, ...lines.map((line) => make('li', {}, line))));
    else
      parts.push(
        make(
          'p',
          { class: 'bv-note' },
          failure ? `No explanation: ${failure}` : 'This build has no explanation of this house.',
        ),
      );
    this.fill(building, title, [name, address].filter((text) => text && !title.includes(text)).join(', '), [
      ...parts,
      attributes,
    ]);
    this.page.say(`${title}. ${lines[0] ?? ''}`);
  }

  private explanations(tile: string): Promise<Record<string, Explanation>> {
    let known = this.tiles.get(tile);
    if (!known) {
      known = this.files.json<Record<string, Explanation>>(`${this.explained}${tile}.json`);
      known.catch(() => this.tiles.delete(tile));
      this.tiles.set(tile, known);
      if (this.tiles.size > KEPT_TILES) this.tiles.delete(this.tiles.keys().next().value!);
    }
    return known;
  }

  private fill(building: string, title: string, below: string, content: HTMLElement[]): void {
    const { panel } = this.page;
    const had_focus = panel.contains(document.activeElement);
    const close = make('button', { type: 'button', class: 'bv-close', 'aria-label': 'Close the house' }, icon('close'));
    close.addEventListener('click', () => this.on_close());
    const copy = make('button', { type: 'button' }, 'Copy link');
    copy.addEventListener('click', () => void this.copy(copy));
    const visit = make('button', { type: 'button' }, 'Go there');
    visit.addEventListener('click', () => this.on_visit());
    const links: HTMLElement[] = [];
    const osm = /^([nwr])(\d+)/.exec(building);
    if (osm) {
      links.push(
        make(
          'a',
          {
            href: `https://www.openstreetmap.org/${OSM_TYPES[osm[1]!]}/${osm[2]}`,
            target: '_blank',
            rel: 'noopener noreferrer',
          },
          `${OSM_TYPES[osm[1]!]} ${osm[2]} in OpenStreetMap`,
        ),
      );
    }
    panel.replaceChildren(
      make(
        'header',
        {},
        make(
          'div',
          {},
          make('h2', { tabindex: -1 }, title),
          ...(below ? [make('p', { class: 'bv-below' }, below)] : []),
        ),
        close,
      ),
      make('div', { class: 'bv-content', tabindex: 0, role: 'region', 'aria-label': 'About the house' }, ...content),
      make('footer', {}, ...links, make('span', { class: 'bv-buttons' }, visit, copy)),
    );
    panel.hidden = false;
    this.page.root.classList.add('bv-has-panel');
    if (had_focus) close.focus();
  }

  private async copy(button: HTMLElement): Promise<void> {
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent = 'Copied';
    } catch {
      // Without the clipboard's permission: the address bar has it.
      button.textContent = 'See the address bar';
    }
    this.page.say(button.textContent);
    setTimeout(() => (button.textContent = 'Copy link'), 2500);
  }
}

function attribute_list(model: TileModel, rows: number[]): HTMLElement {
  const { table } = model,
    row = rows[0]!;
  const sources = sources_of(table.text('sources', row));
  const lines = table
    .row(row)
    .filter(([name]) => !NOT_LISTED.has(name))
    .map(([name, value]) => {
      const source =
        sources.get(name === 'built_roof' ? 'roof_shape' : name === 'style_confidence' ? 'style' : name) ?? '';
      return make(
        'tr',
        {},
        make('th', { scope: 'row' }, name.replaceAll('_', ' ')),
        make('td', {}, ...shown(name, value)),
        make('td', { class: 'bv-source' }, source),
      );
    });
  const title = rows.length > 1 ? `Attributes of the first of ${rows.length} parts` : 'Attributes';
  return make(
    'section',
    {},
    make('h3', {}, title),
    make(
      'table',
      {},
      make(
        'thead',
        {},
        make('tr', {}, ...['Attribute', 'Value', 'Source'].map((text) => make('th', { scope: 'col' }, text))),
      ),
      make('tbody', {}, ...lines),
    ),
  );
}

function shown(name: string, value: Value): (Node | string)[] {
  if (typeof value === 'string' && /^#[0-9a-f]{6}$/i.test(value)) {
    const swatch = make('span', { class: 'bv-swatch', 'aria-hidden': 'true' });
    swatch.style.backgroundColor = value;
    return [swatch, value];
  }
  if (name === 'style_confidence' && typeof value === 'number') return [`${Math.round(100 * value)} %`];
  // In the words of the legend.
  const named = MODES.find((mode) => mode.name === name)?.categories.find(({ key }) => key === value)?.label;
  if (named && typeof value === 'string') return [named];
  const unit = UNITS[name];
  return [`${String(value).replaceAll('_', ' ')}${unit ? (unit === '°' ? unit : ` ${unit}`) : ''}`];
}
