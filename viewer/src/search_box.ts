// The search: a field, and below it what was found. A list box by the pattern of WAI-ARIA: the field keeps the focus.
import { icon, make, Page } from './page';
import type { PlaceLine, Places } from './places';

const MOST = 30;

export class SearchBox {
  on_choose = (_place: PlaceLine): void => {};
  private readonly input = make('input', {
    type: 'search',
    placeholder: 'Address, name or id',
    'aria-label': 'Search for an address, a name or an id',
    autocomplete: 'off',
    spellcheck: 'false',
    role: 'combobox',
    'aria-expanded': 'false',
    'aria-controls': 'bv-hits',
    'aria-autocomplete': 'list',
  });
  private readonly list = make('ul', { id: 'bv-hits', role: 'listbox', 'aria-label': 'Found houses', hidden: true });
  private readonly told = make('p', { class: 'bv-note', hidden: true });
  private hits: PlaceLine[] = [];
  private active = -1;
  private timer = 0;

  constructor(
    private readonly page: Page,
    private readonly places: Places,
  ) {
    page.search.append(make('div', { class: 'bv-field' }, icon('search'), this.input), this.told, this.list);
    this.input.addEventListener('input', () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => void this.run(), 120) as unknown as number;
    });
    this.input.addEventListener('focus', () => {
      if (this.input.value) void this.run();
    });
    this.input.addEventListener('keydown', (event) => this.on_key(event));
    page.root.addEventListener('pointerdown', (event) => {
      if (!page.search.contains(event.target as Node)) this.close();
    });
  }

  get found(): PlaceLine[] {
    return this.hits;
  }

  private async run(): Promise<void> {
    const query = this.input.value;
    if (!query.trim()) return this.close();
    if (!this.places.count) this.tell('Loading addresses …');
    try {
      await this.places.load();
    } catch (error) {
      this.tell('');
      this.page.fail('The list of addresses could not be loaded', (error as Error).message);
      return;
    }
    if (query !== this.input.value) return;
    const { hits, all } = this.places.find(query, MOST);
    this.hits = hits;
    this.activate(-1);
    this.list.replaceChildren(
      ...hits.map((hit, i) => {
        const first = hit.name || hit.address || hit.id;
        const item = make(
          'li',
          { role: 'option', id: `bv-hit-${i}`, 'aria-selected': 'false' },
          make('span', {}, first),
          make(
            'small',
            {},
            [
              hit.name ? hit.address : '',
              first === hit.id ? '' : hit.id,
              hit.height ? `${Math.round(hit.height)} m high` : '',
            ]
              .filter(Boolean)
              .join(' · '),
          ),
        );
        item.addEventListener('click', () => this.choose(hit));
        return item;
      }),
    );
    this.list.hidden = !hits.length;
    this.input.setAttribute('aria-expanded', String(hits.length > 0));
    this.tell(
      !all ? 'Nothing found.' : all > hits.length ? `${all} found, the first ${hits.length} shown.` : `${all} found.`,
    );
  }

  private tell(text: string): void {
    this.told.textContent = text;
    this.told.hidden = !text;
    this.page.say(text);
  }

  private choose(hit: PlaceLine): void {
    clearTimeout(this.timer);
    this.input.value = hit.address || hit.name || hit.id;
    this.close();
    this.on_choose(hit);
  }

  private close(): void {
    this.list.hidden = true;
    this.told.hidden = true;
    this.input.setAttribute('aria-expanded', 'false');
    this.activate(-1);
  }

  private activate(index: number): void {
    this.active = index;
    [...this.list.children].forEach((item, i) => {
      item.setAttribute('aria-selected', String(i === index));
      if (i === index) item.scrollIntoView({ block: 'nearest' });
    });
    if (index >= 0) this.input.setAttribute('aria-activedescendant', `bv-hit-${index}`);
    else this.input.removeAttribute('aria-activedescendant');
  }

  private on_key(event: KeyboardEvent): void {
    const count = this.list.hidden ? 0 : this.hits.length;
    if (event.key === 'Escape') this.close();
    else if (event.key === 'Enter') {
      const hit = this.hits[Math.max(0, this.active)];
      if (count && hit) this.choose(hit);
    } else if (count && (event.key === 'ArrowDown' || event.key === 'ArrowUp')) {
      this.activate((this.active + (event.key === 'ArrowDown' ? 1 : -1) + count) % count);
      event.preventDefault();
    }
  }
}
