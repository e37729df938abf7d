// The card of colours: a choice of what houses are coloured by, and the legend of the choice with numbers.
import { counts, Mode, mode_named, MODES } from './colours';
import { make, Page } from './page';
import type { TileModel } from './tile_model';

export class Legend {
  on_change = (_mode: Mode): void => {};
  private readonly list = make('ul', { class: 'bv-legend' });
  private readonly note = make('p', { class: 'bv-note' });
  private readonly inputs = new Map<string, HTMLInputElement>();
  mode: Mode = MODES[0]!;

  constructor(page: Page) {
    const choice = make('fieldset', { class: 'bv-modes' }, make('legend', {}, 'Colour houses by'));
    for (const mode of MODES) {
      const input = make('input', { type: 'radio', name: 'blockrand-colours', value: mode.name });
      input.addEventListener('change', () => this.choose(mode_named(mode.name), true));
      this.inputs.set(mode.name, input);
      choice.append(make('label', {}, input, make('span', {}, mode.label)));
    }
    page.cards.colours.append(choice, this.list, this.note);
    this.choose(this.mode, false);
  }

  choose(mode: Mode, tell: boolean): void {
    this.mode = mode;
    this.inputs.get(mode.name)!.checked = true;
    if (tell) this.on_change(mode);
  }

  /** Counts anew in these tiles. */
  update(models: Iterable<TileModel>): void {
    const found = counts(models, this.mode);
    this.list.replaceChildren(
      ...this.mode.categories
        .filter((category) => found.get(category))
        .map((category) => {
          const swatch = make('span', { class: 'bv-swatch', 'aria-hidden': 'true' });
          swatch.style.backgroundColor = `#${category.colour.getHexString()}`;
          return make(
            'li',
            {},
            swatch,
            make('span', { class: 'bv-label' }, category.label),
            make('span', { class: 'bv-count' }, String(found.get(category))),
          );
        }),
    );
    this.list.hidden = this.note.hidden = this.mode.name === 'built';
    this.note.textContent = 'Numbers: houses in the tiles that are shown.';
  }

  get entries(): { label: string; count: number; colour: string }[] {
    return [...this.list.children].map((item) => ({
      label: item.querySelector('.bv-label')?.textContent ?? '',
      count: Number(item.querySelector('.bv-count')?.textContent),
      colour: (item.querySelector('.bv-swatch') as HTMLElement).style.backgroundColor,
    }));
  }
}
