// The card of the sun: date and time of day, and where the sun then stands.
import type { Place } from './frame';
import { make, Page } from './page';
import { day_text, sun_position, SunPosition, time_text, zone_of } from './sun';

const DEGREES = 180 / Math.PI;
const WINDS = ['north', 'north-east', 'east', 'south-east', 'south', 'south-west', 'west', 'north-west'];

export class SunCard {
  on_change = (_position: SunPosition): void => {};
  day = 135;
  minutes = 15 * 60 + 15;
  private readonly said = make('p', { class: 'bv-note', 'aria-live': 'polite' });
  private readonly time_out = make('output', {});
  private readonly day_out = make('output', {});

  constructor(
    page: Page,
    private readonly centre: Place,
  ) {
    const time = make('input', {
      type: 'range',
      min: 0,
      max: 1435,
      step: 5,
      value: this.minutes,
      'aria-label': 'Time of day',
    });
    const day = make('input', { type: 'range', min: 1, max: 365, step: 1, value: this.day, 'aria-label': 'Date' });
    time.addEventListener('input', () => this.set(this.day, Number(time.value)));
    day.addEventListener('input', () => this.set(Number(day.value), this.minutes));
    this.day_input = day;
    this.time_input = time;
    page.cards.sun.append(
      make('h2', {}, 'Sun'),
      make('div', { class: 'bv-slider' }, make('span', {}, 'Time'), this.time_out, time),
      make('div', { class: 'bv-slider' }, make('span', {}, 'Date'), this.day_out, day),
      this.said,
    );
    this.show();
  }

  private readonly day_input: HTMLInputElement;
  private readonly time_input: HTMLInputElement;

  get position(): SunPosition {
    return sun_position(this.day, this.minutes, this.centre.lon, this.centre.lat);
  }

  set(day: number, minutes: number): void {
    this.day = day;
    this.minutes = minutes;
    this.show();
    this.on_change(this.position);
  }

  private show(): void {
    const { altitude, azimuth } = this.position,
      zone = zone_of(this.centre.lon);
    const time = `${time_text(this.minutes)} UTC${zone < 0 ? '−' : '+'}${Math.abs(zone)}`,
      day = day_text(this.day);
    this.time_out.textContent = time;
    this.day_out.textContent = day;
    this.time_input.value = String(this.minutes);
    this.day_input.value = String(this.day);
    this.time_input.setAttribute('aria-valuetext', time);
    this.day_input.setAttribute('aria-valuetext', day);
    const wind = WINDS[Math.round((azimuth * DEGREES) / 45) % 8];
    this.said.textContent =
      altitude > 0
        ? `${Math.round(altitude * DEGREES)}° above the horizon, in the ${wind} (${Math.round(azimuth * DEGREES)}°).`
        : `The sun is ${Math.round(-altitude * DEGREES)}° below the horizon.`;
  }
}
