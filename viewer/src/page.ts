// The elements of the page and small helpers to make them. Everything lies inside .blockrand-view, so that a report
// around it keeps its own look.

type Attributes = Record<string, string | number | boolean | undefined>;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children);
  return element;
}

const ICONS = {
  search: 'M10.5 4a6.5 6.5 0 1 1 0 13 6.5 6.5 0 0 1 0-13m5 11.5 5 5',
  colours:
    'M12 3a9 9 0 1 0 0 18c1.6 0 2-1 1.6-2-.5-1.3 0-2.5 1.9-2.500H18a3 3 0 0 0 3-3C21 7.5 17 3 12 3M7.5 12.500v.01M9.5 8v.01M14.5 8v.01',
  sun: 'M12 8a4 4 0 1 1 0 8 4 4 0 0 1 0-8m0-5v2m0 14v2m9-9h-2M5 12H3m15.4-6.4-1.4 1.400M7 17l-1.4 1.400m12.8 0L17 17M7 7 5.6 5.6',
  walk: 'M13 3.500v.01M9 21l2-6 3 2.500V21m-6-9 2-4 4-.5 2 3.5 3 1m-7-4-1 6',
  overview: 'M3 11l9-7 9 7M6 9.500V20h12V9.500M10 20v-5h4v5',
  help: 'M12 3a9 9 0 1 1 0 18 9 9 0 0 1 0-18m-2.5 6.500a2.5 2.5 0 1 1 3.6 2.200c-.8.4-1.1 1-1.1 1.800m0 3v.01',
  close: 'M6 6l12 12M18 6L6 18',
} as const;

export function icon(name: keyof typeof ICONS): SVGSVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  const attributes = {
    viewBox: '0 0 24 24',
    width: '20',
    height: '20',
    fill: 'none',
    stroke: 'currentColor',
    'stroke-width': '1.8',
    'stroke-linecap': 'round',
    'stroke-linejoin': 'round',
    'aria-hidden': 'true',
  };
  for (const [key, value] of Object.entries(attributes)) svg.setAttribute(key, value);
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

export type CardName = 'colours' | 'sun' | 'help';

export class Page {
  readonly root: HTMLElement;
  readonly canvas = make('canvas', {
    tabindex: 0,
    role: 'application',
    'aria-label': 'Houses in 3D. Arrow keys move, plus and minus zoom, Q and E turn; a click on a house explains it.',
  });
  readonly heading = make('h1', {}, 'Blockrand');
  readonly facts = make('p', { class: 'bv-facts' });
  readonly search = make('div', { class: 'bv-search' });
  readonly panel = make('aside', { class: 'bv-panel bv-card', 'aria-label': 'The chosen house', hidden: true });
  readonly attribution = make('div', { class: 'bv-attribution' });
  readonly marker = make('div', { class: 'bv-marker', 'aria-hidden': 'true', hidden: true });
  readonly cards: Record<CardName, HTMLElement> = {
    colours: make('section', { class: 'bv-card bv-option', 'aria-label': 'Colours', hidden: true }),
    sun: make('section', { class: 'bv-card bv-option', 'aria-label': 'Sun', hidden: true }),
    help: make('section', { class: 'bv-card bv-option', 'aria-label': 'Help', hidden: true }),
  };
  readonly walk_button = make(
    'button',
    { type: 'button', 'aria-pressed': 'false' },
    icon('walk'),
    make('span', {}, 'Walk'),
  );
  readonly overview_button = make('button', { type: 'button' }, icon('overview'), make('span', {}, 'Overview'));
  readonly walk_hint = make('div', { class: 'bv-walk', hidden: true });
  private readonly buttons: Record<CardName, HTMLButtonElement>;
  private readonly messages = make('div', { class: 'bv-messages', role: 'alert' });
  private readonly status = make('div', { class: 'bv-status', role: 'status', 'aria-live': 'polite' });
  private readonly progress = make('div', { class: 'bv-progress', hidden: true }, make('span', {}, 'Loading houses'));

  constructor(element: HTMLElement) {
    const button = (name: CardName, text: string) => {
      const made = make('button', { type: 'button', 'aria-expanded': 'false' }, icon(name), make('span', {}, text));
      made.addEventListener('click', () => this.show_card(name, Boolean(this.cards[name].hidden)));
      return made;
    };
    this.buttons = { colours: button('colours', 'Colours'), sun: button('sun', 'Sun'), help: button('help', 'Help') };
    this.root = make(
      'div',
      { class: 'blockrand-view' },
      this.canvas,
      make(
        'div',
        { class: 'bv-top' },
        make('div', { class: 'bv-card bv-title' }, this.heading, this.facts, this.search),
        make('div', { class: 'bv-options' }, this.cards.colours, this.cards.sun, this.cards.help),
      ),
      this.marker,
      this.panel,
      make(
        'div',
        { class: 'bv-bar bv-card', role: 'toolbar', 'aria-label': 'View' },
        this.buttons.colours,
        this.buttons.sun,
        this.walk_button,
        this.overview_button,
        this.buttons.help,
      ),
      this.walk_hint,
      this.progress,
      this.messages,
      this.attribution,
      this.status,
    );
    element.replaceChildren(this.root);
    if (element.clientHeight < 100) this.root.style.height = 'min(80vh, 720px)';
    this.cards.help.append(
      make('h2', {}, 'How to move'),
      make(
        'dl',
        { class: 'bv-keys' },
        ...(
          [
            ['Drag', 'move'],
            ['Right button, or two fingers', 'turn and tilt'],
            ['Wheel, pinch, + and −', 'nearer and farther'],
            ['Arrow keys', 'move; with Shift: turn'],
            ['Q, E', 'turn'],
            ['Click a house', 'what it is and why'],
            ['Walk', 'W A S D or arrows, Shift: faster, Escape: leave'],
          ] as const
        ).flatMap(([what, does]) => [make('dt', {}, what), make('dd', {}, does)]),
      ),
    );
  }

  get narrow(): boolean {
    return this.root.clientWidth <= 640;
  }

  show_card(name: CardName, on: boolean): void {
    // One at a time where they would cover the picture.
    for (const other of Object.keys(this.cards) as CardName[]) {
      const shown: boolean =
        other === name ? on : !this.narrow && other !== 'help' && name !== 'help' && !this.cards[other].hidden;
      this.cards[other].hidden = !shown;
      this.buttons[other].setAttribute('aria-expanded', String(shown));
    }
    this.root.classList.toggle(
      'bv-has-card',
      (Object.keys(this.cards) as CardName[]).some((card) => !this.cards[card].hidden),
    );
    if (on && this.narrow) this.panel.hidden = true;
  }

  /** Read out by screen readers, not shown. */
  say(text: string): void {
    this.status.textContent = text;
  }

  /** What failed, until it is closed. The same text is not shown twice. */
  fail(title: string, reason: string): void {
    const text = `${title}: ${reason}`;
    if ([...this.messages.children].some((child) => child.getAttribute('data-text') === text)) return;
    const close = make(
      'button',
      { type: 'button', class: 'bv-close', 'aria-label': 'Close this message' },
      icon('close'),
    );
    const message = make(
      'div',
      { class: 'bv-message bv-card', 'data-text': text },
      make('div', {}, make('strong', {}, title), make('p', {}, reason)),
      close,
    );
    close.addEventListener('click', () => message.remove());
    if (this.messages.children.length < 3) this.messages.append(message);
  }

  get failures(): string[] {
    return [...this.messages.children].map((child) => child.getAttribute('data-text') ?? '');
  }

  loading(on: boolean): void {
    this.progress.hidden = !on;
  }
}
