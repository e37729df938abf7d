// Moving above the houses: orbit by mouse, touch and keys, flights to a place, and what the camera looks at.
import { MathUtils, PerspectiveCamera, Vector3 } from 'three';
import { MapControls } from 'three/addons/controls/MapControls.js';
import type { Ground } from './ground';

const KEY_STEP = 24; // pixels that a key moves the picture
const FLIGHT = 1300; // ms
const DAMPING = 0.12; // share of a movement that is made good in a frame of a sixtieth of a second

export class Flight {
  readonly controls: MapControls;
  private flight: { from: [Vector3, Vector3]; to: [Vector3, Vector3]; start: number; length: number } | null = null;
  private changed = true;
  private updated = performance.now();
  /** By the reader, ever. */
  touched = false;

  constructor(
    readonly camera: PerspectiveCamera,
    private readonly canvas: HTMLElement,
    private readonly ground: Ground,
  ) {
    this.controls = new MapControls(camera, canvas);
    Object.assign(this.controls, {
      enableDamping: true,
      dampingFactor: DAMPING,
      zoomToCursor: true,
      screenSpacePanning: false,
      minDistance: 12,
      maxDistance: 30000,
      maxPolarAngle: 1.5,
      keyPanSpeed: KEY_STEP,
    });
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener('change', () => (this.changed = true));
    this.controls.addEventListener('start', () => {
      this.flight = null;
      this.touched = true;
    });
    canvas.addEventListener('keydown', this.on_key);
  }

  get target(): Vector3 {
    return this.controls.target;
  }

  set enabled(on: boolean) {
    this.controls.enabled = on;
    if (!on) this.flight = null;
  }

  get enabled(): boolean {
    return this.controls.enabled;
  }

  /** Since the last update. */
  get moved(): boolean {
    return this.changed;
  }

  get flying(): boolean {
    return this.flight !== null;
  }

  /** Looks at a point from a direction (radians from north over east, radians above the horizon) and a distance. */
  look(at: Vector3, distance: number, azimuth: number, altitude: number, at_once: boolean): void {
    const eye = new Vector3(
      -Math.sin(azimuth) * Math.cos(altitude),
      Math.sin(altitude),
      Math.cos(azimuth) * Math.cos(altitude),
    )
      .multiplyScalar(distance)
      .add(at);
    if (at_once || matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.flight = null;
      this.camera.position.copy(eye);
      this.target.copy(at);
      this.changed = true;
      this.controls.update();
      return;
    }
    this.flight = {
      from: [this.camera.position.clone(), this.target.clone()],
      to: [eye, at.clone()],
      start: performance.now(),
      length: FLIGHT,
    };
  }

  /** Flies to a house and keeps the direction of view, but looks down enough to see over its neighbours. */
  visit(foot: Vector3, height: number, above_sheet: boolean): void {
    const offset = this.camera.position.clone().sub(this.target);
    const azimuth = Math.atan2(-offset.x, offset.z);
    const altitude = MathUtils.clamp(
      Math.asin(MathUtils.clamp(offset.y / Math.max(1e-6, offset.length()), -1, 1)),
      0.6,
      0.95,
    );
    // Above the sheet that covers the lower half of a narrow page.
    const distance = (75 + 1.6 * height) * (above_sheet ? 1.5 : 1);
    this.look(
      foot.clone().setY(foot.y + height / 2 - (above_sheet ? 0.2 * distance : 0)),
      distance,
      azimuth,
      altitude,
      false,
    );
  }

  /** Moves on. True: the camera is elsewhere than before. */
  update(): boolean {
    // Movements run out over a time, not over a number of pictures: where the processor draws, sixty take minutes.
    const now = performance.now();
    this.controls.dampingFactor = 1 - (1 - DAMPING) ** ((60 * (now - this.updated)) / 1000);
    this.updated = now;
    if (this.flight) {
      const { from, to, start, length } = this.flight;
      const t = Math.min(1, (performance.now() - start) / length),
        eased = t * t * (3 - 2 * t);
      this.target.lerpVectors(from[1], to[1], eased);
      this.camera.position.lerpVectors(from[0], to[0], eased);
      // A far flight rises on its way.
      this.camera.position.y += Math.sin(Math.PI * eased) * Math.min(900, 0.25 * from[1].distanceTo(to[1]));
      this.changed = true;
      if (t === 1) this.flight = null;
    }
    if (this.enabled) this.follow_ground(() => this.controls.update());
    const lowest = this.ground.at(this.camera.position.x, this.camera.position.z) + 1.5;
    if (this.enabled && this.camera.position.y < lowest) {
      this.camera.position.y = lowest;
      this.changed = true;
    }
    const { changed } = this;
    this.changed = false;
    return changed;
  }

  /** Where the reader moves over hills, the camera goes up and down with the ground. */
  private follow_ground(move: () => void): void {
    const { x, z } = this.target;
    move();
    if (this.flight || (this.target.x === x && this.target.z === z)) return;
    const rise = this.ground.above(this.target.x, this.target.z) - this.ground.above(x, z);
    if (!rise) return;
    this.target.y += rise;
    this.camera.position.y += rise;
  }

  /** In a page that scrolls: wheel and finger are the page's until the picture has the focus. */
  share_page(): void {
    const own = (on: boolean) => {
      this.controls.enableZoom = on;
      this.canvas.style.touchAction = on ? 'none' : 'pan-y';
    };
    own(false);
    this.canvas.addEventListener('focus', () => own(true));
    this.canvas.addEventListener('blur', () => own(false));
  }

  turn(angle: number, nearer = 1): void {
    const offset = this.camera.position
      .clone()
      .sub(this.target)
      .applyAxisAngle(new Vector3(0, 1, 0), angle);
    offset.setLength(MathUtils.clamp(offset.length() * nearer, this.controls.minDistance, this.controls.maxDistance));
    this.camera.position.copy(this.target).add(offset);
    this.changed = true;
    this.controls.update();
  }

  private readonly on_key = (event: KeyboardEvent): void => {
    if (!this.enabled || event.ctrlKey || event.metaKey || event.altKey) return;
    const done: Record<string, () => void> = {
      '+': () => this.turn(0, 0.85),
      '=': () => this.turn(0, 0.85),
      '-': () => this.turn(0, 1.18),
      q: () => this.turn(-0.12),
      e: () => this.turn(0.12),
    };
    const action = done[event.key];
    if (!action) return;
    action();
    event.preventDefault();
  };

  dispose(): void {
    this.canvas.removeEventListener('keydown', this.on_key);
    this.controls.dispose();
  }
}
