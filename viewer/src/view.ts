// The view as a whole: what is chosen, where the camera is, and when a new picture is drawn. Pictures are drawn only
// when something changed.
import {
  NeutralToneMapping,
  PCFShadowMap,
  PerspectiveCamera,
  Raycaster,
  Scene,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { Mode, mode_named, paint_tile } from './colours';
import type { Files } from './files';
import { FileMissing } from './files';
import { Flight } from './flight';
import { Frame, Place } from './frame';
import { HousePanel } from './house_panel';
import { Legend } from './legend';
import { read_link, write_link } from './link';
import { Model } from './model';
import { PAINT } from './paint';
import { make, Page } from './page';
import { PlaceLine, Places } from './places';
import { SearchBox } from './search_box';
import { SunCard } from './sun_card';
import { Surroundings } from './surroundings';
import { Walk } from './walk';

const SUNK = 5; // m that walls go into hilly ground
const MEGABYTE = 1 << 20;
const CLICK = 6; // pixels and
const CLICK_TIME = 500; // ms that a click may wander and last
const TIMES_KEPT = 240;
const SLOW = 70; // ms: where pictures take longer, those of a movement have fewer pixels
const MOVING_SCALE = 0.5; // of the width and height
const LOADING_PAUSE = 280; // ms between pictures while tiles arrive, where the processor draws

/** view.json, checked. */
export interface Description {
  name: string;
  lod: number;
  buildings: number;
  attribution: string;
  centre: Place;
  tileset: string;
  places: string[];
  explained: string | null;
  data_time: string;
}

export function describe(told: unknown): Description {
  const given = (told ?? {}) as Partial<Description>;
  const { lon, lat, height } = given.centre ?? ({} as Partial<Place>);
  if (typeof given.tileset !== 'string') throw new FileMissing('view.json', 'names no tileset');
  if (!Number.isFinite(lon) || !Number.isFinite(lat)) throw new FileMissing('view.json', 'has no centre');
  return {
    name: given.name ?? '',
    lod: given.lod ?? 0,
    buildings: given.buildings ?? 0,
    attribution: given.attribution ?? '© OpenStreetMap contributors, ODbL 1.0',
    centre: { lon: lon!, lat: lat!, height: Number.isFinite(height) ? height! : 0 },
    tileset: given.tileset,
    places: given.places ?? [],
    explained: given.explained ?? null,
    data_time: given.data_time ?? '',
  };
}

export class View {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(42, 1, 0.5, 50000);
  private readonly model: Model;
  private readonly frame: Frame;
  private readonly surroundings: Surroundings;
  private readonly flight: Flight;
  private readonly walk: Walk;
  private readonly legend: Legend;
  private readonly sun: SunCard;
  private readonly places: Places;
  private readonly search: SearchBox;
  private readonly panel: HousePanel;
  private readonly software: boolean;
  private chosen: string | null = null;
  private chosen_place: PlaceLine | null = null;
  private shown_in_panel: string | null = null;
  private dirty = true;
  private shapes_changed = true;
  private legend_stale = true;
  private placed = false;
  private first_picture = false;
  private readonly times: number[] = [];
  private last_frame = 0;
  private last_drawn = 0;
  private drawn = 0;
  private first_after = 0;
  private readonly ready: Promise<void>;
  private tell_ready = (): void => {};

  constructor(
    private readonly page: Page,
    files: Files,
    private readonly told: Description,
  ) {
    this.ready = new Promise((done) => (this.tell_ready = done));
    this.software = drawn_by_software();
    this.renderer = new WebGLRenderer({
      canvas: page.canvas,
      antialias: !this.software,
      powerPreference: 'high-performance',
    });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.0;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.surroundings = new Surroundings(this.scene, this.renderer, this.software ? 1536 : 2048);
    this.frame = new Frame(told.centre);
    this.model = new Model(
      files,
      this.frame,
      told.tileset,
      this.software ? { error: 18, near: 70, bytes: 300 * MEGABYTE } : { error: 10, near: 140, bytes: 512 * MEGABYTE },
    );
    this.scene.add(this.model.tiles.group);
    const { ground } = this.surroundings;
    this.flight = new Flight(this.camera, page.canvas, ground);
    this.walk = new Walk(this.camera, page.canvas, ground);
    this.legend = new Legend(page);
    this.sun = new SunCard(page, told.centre);
    this.places = new Places(files, told.places);
    this.search = new SearchBox(page, this.places);
    this.panel = new HousePanel(page, files, told.explained);
    this.describe_build();
    this.connect();
    this.overview(true);
    this.surroundings.set_sun(this.sun.position);
    new ResizeObserver(() => this.resize()).observe(page.root);
    this.resize();
    this.follow_link();
  }

  run(): void {
    this.page.loading(true);
    const next = () => {
      this.step();
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  /** window.blockrandView. */
  get for_tests() {
    // `look` is for tests that fly about.
    return {
      ready: this.ready,
      /** Height of the ground above the plane. */
      ground: (x: number, z: number) => this.surroundings.ground.above(x, z),
      /** Milliseconds between the last pictures that followed each other. */
      frameTimes: () => [...this.times],
      memory: () => ({ bytes: this.model.bytes + this.surroundings.ground.bytes, tiles: this.model.models.size }),
      state: () => this.state(),
      look: (x: number, z: number, distance: number, azimuth: number, altitude: number) =>
        this.flight.look(new Vector3(x, this.surroundings.ground.at(x, z), z), distance, azimuth, altitude, true),
    };
  }

  private state() {
    const { altitude, azimuth } = this.sun.position;
    return {
      settled: this.model.settled && this.surroundings.ground.settled && !this.flight.flying && !this.flight.moved && !this.dirty && this.sharp,
      first_picture_ms: this.first_after,
      software: this.software,
      pictures: this.drawn,
      house: this.chosen,
      colour: this.legend.mode.name,
      legend: this.legend.entries,
      walking: this.walk.active,
      camera: this.camera.position.toArray(),
      target: this.flight.target.toArray(),
      /** Height under the camera. */
      ground: this.surroundings.ground.at(this.camera.position.x, this.camera.position.z),
      hilly: this.surroundings.ground.hilly,
      direction: this.camera.getWorldDirection(new Vector3()).toArray(),
      sun: { day: this.sun.day, minutes: this.sun.minutes, altitude, azimuth },
      shown: this.model.shown.map((model) => model.name),
      triangles: this.renderer.info.render.triangles,
      calls: this.renderer.info.render.calls,
      found: this.search.found.map(({ id }) => id),
      failures: this.page.failures,
      on_screen: this.chosen ? this.on_screen(this.chosen) : null,
    };
  }

  private describe_build(): void {
    const { name, buildings, lod, data_time, attribution } = this.told;
    this.page.heading.textContent = name || 'Houses';
    const facts: string[] = [buildings ? `${buildings.toLocaleString('en')} houses` : '', lod ? `LoD${lod}` : ''];
    this.page.facts.textContent = facts.filter(Boolean).join(' · ');
    if (data_time)
      this.page.facts.append(make('span', {}, `${facts.some(Boolean) ? ' · ' : ''}data of ${data_time.slice(0, 10)}`));
    this.page.attribution.append(attribution);
    if (!this.told.places.length) this.page.search.hidden = true;
    if (!page_is_ours()) this.flight.share_page();
    else document.title = name ? `${name} · Blockrand` : 'Blockrand';
  }

  private connect(): void {
    const { page, model } = this;
    model.on_change = (shapes) => {
      this.dirty = true;
      this.shapes_changed ||= shapes;
      this.legend_stale = true;
    };
    model.on_load = (tile) => {
      this.surroundings.ground.add(model.feet(tile));
      paint_tile(tile, this.legend.mode, this.chosen);
      if (this.chosen && tile.rows_of.has(this.chosen)) void this.fill_panel();
    };
    model.on_error = (message) => page.fail('A part of the model could not be loaded', message);
    this.legend.on_change = (mode) => this.set_mode(mode);
    this.sun.on_change = (position) => {
      this.surroundings.set_sun(position);
      this.dirty = true;
    };
    this.search.on_choose = (place) => this.choose_place(place);
    this.panel.on_close = () => {
      this.choose(null);
      page.canvas.focus();
    };
    this.panel.on_visit = () => this.visit();
    page.overview_button.addEventListener('click', () => {
      this.walk.stop();
      this.overview(false);
    });
    page.walk_button.addEventListener('click', () => (this.walk.active ? this.walk.stop() : this.start_walk()));
    this.walk.on_end = () => this.end_walk();
    const hold = (code: string, text: string, label: string) => {
      const button = make('button', { type: 'button', 'aria-label': label }, text);
      button.addEventListener('pointerdown', (event) => {
        button.setPointerCapture(event.pointerId);
        this.walk.hold(code, true);
      });
      for (const end of ['pointerup', 'pointercancel'] as const)
        button.addEventListener(end, () => this.walk.hold(code, false));
      return button;
    };
    const leave = make('button', { type: 'button' }, 'Leave');
    leave.addEventListener('click', () => this.walk.stop());
    page.walk_hint.append(
      make('span', { class: 'bv-walk-keys' }, 'W A S D or arrows walk, the mouse looks, Esc leaves'),
      hold('KeyA', '◀', 'Step left'),
      hold('KeyW', '▲', 'Walk forwards'),
      hold('KeyS', '▼', 'Walk backwards'),
      hold('KeyD', '▶', 'Step right'),
      leave,
    );
    this.watch_clicks();
    addEventListener('hashchange', () => this.follow_link());
    page.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      page.fail('The graphics driver gave up', 'Reload the page to start again.');
    });
    if (!page.narrow) page.show_card('colours', true);
  }

  private watch_clicks(): void {
    const { canvas } = this.page;
    let down: { x: number; y: number; at: number } | null = null;
    canvas.addEventListener('pointerdown', (event) => {
      down =
        event.button === 0 && event.isPrimary ? { x: event.clientX, y: event.clientY, at: performance.now() } : null;
    });
    canvas.addEventListener('pointerup', (event) => {
      const still =
        down &&
        event.isPrimary &&
        Math.hypot(event.clientX - down.x, event.clientY - down.y) < CLICK &&
        performance.now() - down.at < CLICK_TIME;
      down = null;
      if (!still) return;
      const box = canvas.getBoundingClientRect();
      const locked = document.pointerLockElement === canvas;
      const at = locked
        ? new Vector2()
        : new Vector2(
            ((event.clientX - box.left) / box.width) * 2 - 1,
            1 - ((event.clientY - box.top) / box.height) * 2,
          );
      const ray = new Raycaster();
      ray.setFromCamera(at, this.camera);
      const hit = this.model.hit(ray);
      const { origin, direction } = ray.ray;
      const reach = (hit?.distance ?? 0) - 2;
      const seen = hit && this.surroundings.ground.free(origin, direction, reach) >= reach;
      this.choose(seen ? hit.model.building_of(hit.row) : null);
    });
  }

  // ---- what is chosen

  private choose(building: string | null, place: PlaceLine | null = null): void {
    if (building === this.chosen && building !== null && this.shown_in_panel === building) {
      this.page.panel.hidden = false;
      return;
    }
    this.chosen = building;
    this.chosen_place = place;
    this.shown_in_panel = null;
    this.repaint();
    this.keep_link();
    if (building === null) {
      this.panel.close();
      return;
    }
    if (this.page.narrow) for (const name of ['colours', 'sun', 'help'] as const) this.page.show_card(name, false);
    if (this.model.find(building)) void this.fill_panel();
    else this.panel.wait_for(building, place?.name || place?.address || building);
  }

  private async fill_panel(): Promise<void> {
    const found = this.chosen && this.model.find(this.chosen);
    if (!found || this.shown_in_panel === this.chosen) return;
    this.shown_in_panel = this.chosen;
    this.repaint();
    await this.panel.show(this.chosen!, found.model, found.rows);
  }

  private choose_place(place: PlaceLine): void {
    this.walk.stop();
    this.choose(place.id, place);
    this.visit();
    this.page.canvas.focus();
  }

  private visit(): void {
    if (!this.chosen) return;
    this.walk.stop();
    const found = this.model.find(this.chosen),
      place = this.chosen_place;
    if (found) {
      const { foot, height } = this.model.place(found.model, found.rows);
      this.flight.visit(foot, height, this.page.narrow);
    } else if (place) this.flight.visit(this.place_on_ground(place), place.height, this.page.narrow);
  }

  /** A house of the link may be anywhere: loaded already, or in the list of places. */
  private async follow_link(): Promise<void> {
    const { house, colour } = read_link();
    const mode = mode_named(colour);
    if (mode !== this.legend.mode && (colour || this.first_picture)) this.legend.choose(mode, true);
    if (house === this.chosen || !house) return;
    if (!this.model.find(house) && this.told.places.length) {
      try {
        await this.places.load();
      } catch (error) {
        this.page.fail('The list of addresses could not be loaded', (error as Error).message);
      }
      const place = this.places.by_id(house);
      if (place) return this.choose_place(place);
    }
    await this.ready;
    if (this.model.find(house)) {
      this.choose(house);
      this.visit();
    } else
      this.page.fail('House of the link not found', `${house} is not in this build, or not among the houses shown.`);
  }

  private keep_link(): void {
    write_link({ house: this.chosen, colour: this.legend.mode.name });
  }

  private set_mode(_mode: Mode): void {
    this.repaint();
    this.keep_link();
    this.legend_stale = true;
    this.page.say(`Coloured by ${this.legend.mode.label}`);
  }

  private repaint(): void {
    for (const model of this.model.models) paint_tile(model, this.legend.mode, this.chosen);
    this.dirty = true;
  }

  // ---- where the camera is

  private overview(at_once: boolean): void {
    const sphere = this.placed ? this.model.sphere() : null;
    const middle = new Vector3(0, 8 + this.surroundings.ground.above(0, 0), 0);
    const distance = Math.min(900, Math.max(160, (sphere?.radius ?? 330) * 1.25));
    this.flight.look(middle, distance, 0.32, this.camera.aspect < 0.8 ? 0.6 : 0.38, at_once);
    this.dirty = true;
  }

  private start_walk(): void {
    const from = this.open_place(this.flight.target.clone());
    this.flight.enabled = false;
    this.walk.start(from, this.clear_view(from).towards);
    this.page.walk_hint.hidden = false;
    this.page.walk_button.setAttribute('aria-pressed', 'true');
    this.page.root.classList.add('bv-walking');
    this.page.panel.hidden = true;
    this.page.say('Walking. W A S D or arrow keys walk, Escape leaves.');
    this.dirty = true;
  }

  /** A place near by that is not under a roof and not right before a wall. */
  private open_place(near: Vector3): Vector3 {
    const ray = new Raycaster();
    let best = near,
      widest = -1,
      tried = 0;
    for (let ring = 0; ring < 10 && tried < 5; ++ring) {
      for (let i = 0; i < (ring ? 8 : 1) && tried < 5; ++i) {
        const angle = (i * Math.PI) / 4,
          at = new Vector3(near.x + 6 * ring * Math.cos(angle), 0, near.z + 6 * ring * Math.sin(angle));
        ray.set(at.clone().setY(500 + this.surroundings.ground.at(at.x, at.z)), new Vector3(0, -1, 0));
        if (this.model.hit(ray)) continue;
        ++tried;
        const { room } = this.clear_view(at);
        if (room > widest) [best, widest] = [at, room];
        if (room > 5) return at;
      }
    }
    return best;
  }

  /** Where one sees farthest from a place, and how far the nearest wall is. */
  private clear_view(at: Vector3): { towards: Vector3; room: number } {
    const eye = at.clone().setY(this.surroundings.ground.at(at.x, at.z) + 2.2),
      ray = new Raycaster();
    let farthest = -1,
      room = Infinity;
    const towards = at.clone();
    for (let i = 0; i < 12; ++i) {
      const direction = new Vector3(Math.cos((i * Math.PI) / 6), 0, Math.sin((i * Math.PI) / 6));
      ray.set(eye, direction);
      const distance = this.surroundings.ground.free(eye, direction, Math.min(150, this.model.hit(ray)?.distance ?? 150));
      room = Math.min(room, distance);
      if (distance > farthest) {
        farthest = distance;
        towards.copy(at).addScaledVector(direction, 50);
      }
    }
    return { towards, room };
  }

  private end_walk(): void {
    const ahead = this.walk.ahead(30);
    const azimuth = Math.atan2(ahead.x - this.camera.position.x, this.camera.position.z - ahead.z);
    this.flight.enabled = true;
    this.flight.look(ahead, 130, azimuth, 0.6, false);
    this.page.walk_hint.hidden = true;
    this.page.walk_button.setAttribute('aria-pressed', 'false');
    this.page.root.classList.remove('bv-walking');
    this.dirty = true;
  }

  private on_screen(building: string): [number, number] | null {
    const found = this.model.find(building);
    if (!found) return null;
    const { foot, height } = this.model.place(found.model, found.rows);
    const at = foot.setY(foot.y + height + 1.5).project(this.camera);
    if (at.z > 1 || at.z < -1) return null;
    return [((at.x + 1) / 2) * this.page.root.clientWidth, ((1 - at.y) / 2) * this.page.root.clientHeight];
  }

  // ---- pictures

  private resize(): void {
    const width = Math.max(1, this.page.root.clientWidth),
      height = Math.max(1, this.page.root.clientHeight);
    this.set_sharpness(this.sharp);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.model.watch(this.camera, this.renderer);
    this.dirty = true;
    this.moved_by_size = true;
  }

  private moved_by_size = true;
  private sharp = false;

  private set_sharpness(sharp: boolean): void {
    this.sharp = sharp;
    PAINT.hatching.value = 1 / (14 * this.pixel_ratio(sharp));
    this.renderer.setPixelRatio(this.pixel_ratio(sharp));
    this.renderer.setSize(Math.max(1, this.page.root.clientWidth), Math.max(1, this.page.root.clientHeight), false);
  }

  private pixel_ratio(sharp: boolean): number {
    return (this.software ? 1 : Math.min(2, devicePixelRatio)) * (sharp ? 1 : MOVING_SCALE);
  }

  private get slow(): boolean {
    const last = this.times.slice(-6);
    return this.software || (last.length === 6 && last.reduce((sum, time) => sum + time) / 6 > SLOW);
  }

  private step(): void {
    const moved = (this.walk.active ? this.walk.update() : this.flight.update()) || this.moved_by_size;
    this.moved_by_size = false;
    this.surroundings.follow(this.camera, this.walk.active ? this.walk.ahead(40) : this.flight.target, false);
    this.model.update(this.camera, moved);
    if (!this.placed && this.model.sphere()) {
      this.placed = true;
      if (!this.chosen) this.overview(true);
    }
    if (this.surroundings.ground.update(this.focus, !this.model.settled)) this.ground_changed();
    const settled = this.model.settled && this.surroundings.ground.settled;
    this.page.loading(!settled && this.page.failures.length === 0);
    const still = !moved && settled;
    if (!moved && !this.dirty && (this.sharp || !still)) {
      this.last_frame = 0;
      if (settled && this.legend_stale) this.update_legend();
      return;
    }
    if (this.software && !moved && !settled && performance.now() - this.last_drawn < LOADING_PAUSE) return;
    const sharp = still || !this.slow;
    if (sharp !== this.sharp) this.set_sharpness(sharp);
    this.dirty = false;
    if (this.shapes_changed && (still || !this.software))
      this.surroundings.follow(this.camera, this.walk.active ? this.walk.ahead(40) : this.flight.target, true);
    if (still || !this.software) this.shapes_changed = false;
    this.renderer.render(this.scene, this.camera);
    ++this.drawn;
    this.place_marker();
    const now = performance.now();
    this.last_drawn = now;
    if (this.last_frame) {
      this.times.push(now - this.last_frame);
      if (this.times.length > TIMES_KEPT) this.times.shift();
    }
    this.last_frame = now;
    if (settled) this.update_legend();
    if (settled && this.placed && !this.first_picture) this.note_first_picture();
  }

  private get focus(): Vector3 {
    return this.walk.active ? this.camera.position : this.flight.target;
  }

  private ground_changed(): void {
    const { hilly } = this.surroundings.ground;
    PAINT.sunk.value = hilly ? SUNK : 0;
    // The first look was before anything told how high the ground is.
    if (!this.first_picture && !this.chosen && !this.flight.touched) this.overview(true);
    if (this.walk.active) this.walk.stand();
    this.dirty = true;
  }

  private place_on_ground({ lon, lat }: PlaceLine): Vector3 {
    const at = this.frame.point(lon, lat, 0);
    return at.setY(at.y + this.surroundings.ground.above(at.x, at.z));
  }

  private note_first_picture(): void {
    this.first_picture = true;
    // What was asked of the graphics unit is drawn when the next picture can begin.
    requestAnimationFrame(() => {
      this.first_after = performance.now();
      this.tell_ready();
    });
  }

  private update_legend(): void {
    this.legend_stale = false;
    this.legend.update(this.model.shown);
  }

  private place_marker(): void {
    const { marker } = this.page;
    const at = this.chosen && !this.walk.active ? this.on_screen(this.chosen) : null;
    marker.hidden = !at;
    if (at) marker.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
  }
}

/** index.html, not a page around the viewer. */
function page_is_ours(): boolean {
  return document.body.classList.contains('blockrand-page');
}

/** Whether the processor draws, as on machines without a graphics unit. Throws where nothing can draw. */
function drawn_by_software(): boolean {
  const gl = make('canvas').getContext('webgl2');
  if (!gl)
    throw new Error(
      'this browser gives no WebGL 2. It may be switched off in its settings, or the graphics driver is blocked.',
    );
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
