// Walking through the streets at eye height: keys or buttons to go, the mouse or a finger to look, Escape to leave.
import { Euler, PerspectiveCamera, Vector3 } from 'three';
import type { Ground } from './ground';

const EYE = 1.7; // m
const PACE = 4.2; // m/s, a brisk run; with shift three times as fast
const KEYS: Record<string, [number, number]> = {
  KeyW: [1, 0],
  ArrowUp: [1, 0],
  KeyS: [-1, 0],
  ArrowDown: [-1, 0],
  KeyD: [0, 1],
  ArrowRight: [0, 1],
  KeyA: [0, -1],
  ArrowLeft: [0, -1],
};

export class Walk {
  active = false;
  on_end = (): void => {};
  private readonly pressed = new Set<string>();
  private readonly look = new Euler(0, 0, 0, 'YXZ');
  private before = 0;
  private turned = false;
  private dragged: number | null = null;
  private fast = false;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly canvas: HTMLElement,
    private readonly ground: Ground,
  ) {
    addEventListener('keydown', this.on_key);
    addEventListener('keyup', this.on_key_up);
    addEventListener('blur', () => this.pressed.clear());
    document.addEventListener('pointerlockchange', this.on_lock);
    canvas.addEventListener('pointerdown', this.on_down);
    canvas.addEventListener('pointermove', this.on_move);
    canvas.addEventListener('pointerup', this.on_up);
    canvas.addEventListener('pointercancel', this.on_up);
  }

  start(at: Vector3, towards: Vector3): void {
    this.active = true;
    this.turned = true;
    this.before = performance.now();
    this.camera.position.set(at.x, this.ground.at(at.x, at.z) + EYE, at.z);
    this.look.set(0.03, Math.atan2(at.x - towards.x, at.z - towards.z), 0);
    this.canvas.focus();
    if (matchMedia('(pointer: fine)').matches) {
      // Where the browser refuses, dragging looks around.
      const asked = this.canvas.requestPointerLock?.() as unknown as Promise<void> | undefined;
      asked?.catch?.(() => {});
    }
  }

  stop(): void {
    if (!this.active) return;
    this.active = false;
    this.pressed.clear();
    if (document.pointerLockElement === this.canvas) document.exitPointerLock();
    this.on_end();
  }

  /** The ground changed. */
  stand(): void {
    this.turned = true;
  }

  /** A button of the page that is held: 'KeyW' and its like. */
  hold(code: string, down: boolean): void {
    if (down) this.pressed.add(code);
    else this.pressed.delete(code);
  }

  /** A point some metres ahead on the ground. */
  ahead(metres: number): Vector3 {
    const at = this.camera.position,
      x = at.x - Math.sin(this.look.y) * metres,
      z = at.z - Math.cos(this.look.y) * metres;
    return new Vector3(x, this.ground.at(x, z), z);
  }

  /** Walks on. True: the camera moved. */
  update(): boolean {
    const now = performance.now(),
      seconds = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    let forward = 0,
      right = 0;
    for (const code of this.pressed) {
      forward += KEYS[code]?.[0] ?? 0;
      right += KEYS[code]?.[1] ?? 0;
    }
    const moved = forward !== 0 || right !== 0 || this.turned;
    this.turned = false;
    const step = (seconds * PACE * (this.fast ? 3 : 1)) / Math.max(1, Math.hypot(forward, right));
    const at = this.camera.position,
      sin = Math.sin(this.look.y),
      cos = Math.cos(this.look.y);
    at.x += (-sin * forward + cos * right) * step;
    at.z += (-cos * forward - sin * right) * step;
    at.y = this.ground.at(at.x, at.z) + EYE;
    this.camera.quaternion.setFromEuler(this.look);
    return moved;
  }

  private turn(dx: number, dy: number): void {
    this.look.y -= dx * 0.0028;
    this.look.x = Math.max(-1.2, Math.min(1.3, this.look.x - dy * 0.0028));
    this.turned = true;
  }

  private readonly on_key = (event: KeyboardEvent): void => {
    if (!this.active) return;
    this.fast = event.shiftKey;
    if (event.key === 'Escape') this.stop();
    else if (event.code in KEYS && !(event.target instanceof HTMLInputElement)) {
      this.pressed.add(event.code);
      event.preventDefault();
    }
  };

  private readonly on_key_up = (event: KeyboardEvent): void => {
    this.fast = event.shiftKey;
    this.pressed.delete(event.code);
  };

  private locked = false;
  private readonly on_lock = (): void => {
    const locked = document.pointerLockElement === this.canvas;
    if (this.locked && !locked) this.stop();
    this.locked = locked;
  };

  private readonly on_down = (event: PointerEvent): void => {
    if (!this.active) return;
    this.dragged = event.pointerId;
    if (!this.locked) this.canvas.setPointerCapture(event.pointerId);
  };

  private readonly on_move = (event: PointerEvent): void => {
    if (this.active && (this.locked || this.dragged === event.pointerId)) this.turn(event.movementX, event.movementY);
  };

  private readonly on_up = (): void => {
    this.dragged = null;
  };

  dispose(): void {
    removeEventListener('keydown', this.on_key);
    removeEventListener('keyup', this.on_key_up);
    document.removeEventListener('pointerlockchange', this.on_lock);
  }
}
