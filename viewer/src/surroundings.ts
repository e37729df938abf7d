// What houses stand in: sky, ground and light, all following the sun.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  ShaderMaterial,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
} from 'three';
import { Frame } from './frame';
import { Ground } from './ground';
import { PAINT } from './paint';
import type { SunPosition } from './sun';

// By the sun's altitude in degrees: sky above, sky at the horizon, sunlight and its strength, strength of skylight, lamps in windows.
const DAYLIGHT: [number, string, string, string, number, number, number][] = [
  [-18, '#070b16', '#131b2c', '#8fa6d6', 0, 1.4, 0.85],
  [-7, '#13213f', '#4a4a66', '#8fa6d6', 0, 1.4, 0.8],
  [-1, '#33538a', '#d99a72', '#ff8a4a', 0.3, 1.7, 0.45],
  [5, '#4b7fbe', '#f0cfa8', '#ffb271', 1.9, 1.8, 0.1],
  [16, '#4d8fd2', '#dde7ec', '#ffe0b5', 2.7, 2.3, 0],
  [40, '#3f86cf', '#d3e4ef', '#fff3e2', 2.9, 2.6, 0],
];

const GROUND = '#c9c6bb';

const SKY_VERTEX = /* glsl */ `
varying vec3 v_out;
void main() {
  v_out = position;
  gl_Position = projectionMatrix * mat4(mat3(modelViewMatrix)) * vec4(position, 1.0);
  gl_Position.z = gl_Position.w * 0.999999;
}`;
const SKY_FRAGMENT = /* glsl */ `
uniform vec3 sky_zenith;
uniform vec3 sky_horizon;
uniform vec3 sun_colour;
uniform vec3 sun_direction;
varying vec3 v_out;
void main() {
  vec3 look = normalize(v_out);
  vec3 colour = mix(sky_horizon, sky_zenith, pow(max(look.y, 0.0), 0.5));
  float towards = max(dot(look, sun_direction), 0.0);
  colour += sun_colour * (pow(towards, 900.0) * 1.4 + pow(towards, 24.0) * 0.05);
  gl_FragColor = vec4(colour, 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
}`;

export class Surroundings {
  readonly sun = new DirectionalLight();
  private readonly skylight = new HemisphereLight();
  private readonly fog = new Fog('#ffffff', 1500, 9000);
  private readonly direction = new Vector3(0, 1, 0);
  private readonly shadow_middle = new Vector3(Infinity, 0, 0);
  private shadow_reach = 0;
  readonly ground = new Ground(GROUND);

  constructor(
    private readonly scene: Scene,
    private readonly renderer: WebGLRenderer,
    shadow_pixels: number,
  ) {
    const sky = new Mesh(
      new SphereGeometry(1, 48, 24),
      new ShaderMaterial({
        vertexShader: SKY_VERTEX,
        fragmentShader: SKY_FRAGMENT,
        side: BackSide,
        depthWrite: false,
        uniforms: {
          sky_zenith: PAINT.sky_zenith,
          sky_horizon: PAINT.sky_horizon,
          sun_colour: PAINT.sun_colour,
          sun_direction: PAINT.sun_direction,
        },
      }),
    );
    // Houses first, then what they leave free.
    sky.renderOrder = 2;
    sky.frustumCulled = false;
    const ground = new Mesh(curved_disc(), new MeshLambertMaterial({ color: GROUND }));
    ground.receiveShadow = true;
    ground.renderOrder = 1;
    ground.position.y = -0.03;
    scene.fog = this.fog;
    scene.add(sky, ground, this.ground.group, this.sun, this.sun.target, this.skylight);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(shadow_pixels, shadow_pixels);
    this.sun.shadow.radius = 1.3;
    this.sun.shadow.bias = -0.0004;
    this.renderer.shadowMap.autoUpdate = false;
  }

  set_sun(position: SunPosition): void {
    const degrees = (position.altitude * 180) / Math.PI;
    const above = Math.max(
      0,
      DAYLIGHT.findIndex(([altitude], i) => i > 0 && degrees <= altitude),
    );
    const high = DAYLIGHT[degrees >= 40 ? DAYLIGHT.length - 1 : above]!,
      low = DAYLIGHT[degrees >= 40 ? DAYLIGHT.length - 1 : Math.max(0, above - 1)]!;
    const t = high === low ? 0 : Math.min(1, Math.max(0, (degrees - low[0]) / (high[0] - low[0])));
    const colour = (at: 1 | 2 | 3) => new Color(low[at]).lerp(new Color(high[at]), t);
    const number = (at: 4 | 5 | 6) => low[at] + t * (high[at] - low[at]);
    const night = degrees < -1;
    // At night the moon lights from the south-west, faintly: shapes stay readable.
    const { altitude, azimuth } = night
      ? { altitude: 0.7, azimuth: 3.9 }
      : { altitude: Math.max(position.altitude, 0.02), azimuth: position.azimuth };
    this.direction.set(
      Math.sin(azimuth) * Math.cos(altitude),
      Math.sin(altitude),
      -Math.cos(azimuth) * Math.cos(altitude),
    );
    PAINT.sky_zenith.value.copy(colour(1));
    PAINT.sky_horizon.value.copy(colour(2));
    PAINT.sun_colour.value.copy(colour(3)).multiplyScalar(night ? 0 : number(4) / 3);
    PAINT.sun_direction.value = this.direction.toArray();
    PAINT.lamps.value = number(6);
    this.sun.color.copy(colour(3));
    this.sun.intensity = night ? 0.8 : number(4);
    this.skylight.color.copy(colour(1)).lerp(colour(2), 0.7).lerp(new Color('#ffffff'), 0.45);
    this.skylight.groundColor.set('#a59c88').multiplyScalar(night ? 0.35 : Math.min(1, 0.25 + number(5) * 0.45));
    this.skylight.intensity = number(5);
    this.fog.color.copy(colour(2));
    this.shadow_reach = 0;
  }

  /** Keeps light and haze about what the camera looks at. shapes: what casts shadows changed. */
  follow(camera: PerspectiveCamera, looked_at: Vector3, shapes: boolean): void {
    const distance = camera.position.distanceTo(looked_at);
    this.fog.near = 350 + 1.6 * distance;
    this.fog.far = 4000 + 7 * distance;
    const height = Math.max(2, camera.position.y - this.ground.at(camera.position.x, camera.position.z));
    camera.near = Math.min(20, Math.max(0.15, height / 40));
    camera.far = 30000 + 20 * height;
    camera.updateProjectionMatrix();
    const reach = Math.min(1500, Math.max(90, distance * 0.95));
    const outgrown =
      this.shadow_reach === 0 ||
      reach > 1.15 * this.shadow_reach ||
      reach < 0.6 * this.shadow_reach ||
      this.shadow_middle.distanceTo(looked_at) > 0.2 * this.shadow_reach;
    if (outgrown) {
      this.shadow_reach = reach;
      this.shadow_middle.copy(looked_at);
      const box = this.sun.shadow.camera;
      box.left = box.bottom = -reach;
      box.right = box.top = reach;
      box.near = 1;
      box.far = 4 * reach + 800;
      box.updateProjectionMatrix();
      this.sun.shadow.normalBias = Math.max(0.05, (reach / this.sun.shadow.mapSize.x) * 1.6);
      this.sun.position.copy(looked_at).addScaledVector(this.direction, 2 * reach + 400);
      this.sun.target.position.copy(looked_at);
      this.sun.target.updateMatrixWorld();
    }
    if (outgrown || shapes) this.renderer.shadowMap.needsUpdate = true;
  }

  get sun_direction(): Vector3 {
    return this.direction;
  }

  dispose(): void {
    this.ground.dispose();
    this.sun.shadow.map?.dispose();
    this.scene.clear();
  }
}

/** The ground to 40 km around the origin, falling away as the Earth does. */
function curved_disc(): BufferGeometry {
  const rings = [0];
  for (let r = 60; r < 40000; r += Math.min(700, Math.max(60, 0.12 * r))) rings.push(r);
  const sectors = 128;
  const positions = new Float32Array(3 * rings.length * sectors),
    normals = new Float32Array(positions.length);
  const index: number[] = [];
  rings.forEach((r, ring) => {
    for (let s = 0; s < sectors; ++s) {
      const at = ring * sectors + s,
        angle = (2 * Math.PI * s) / sectors;
      positions.set([r * Math.cos(angle), Frame.ground_at(r, 0), r * Math.sin(angle)], 3 * at);
      normals[3 * at + 1] = 1;
      const next = ring * sectors + ((s + 1) % sectors);
      if (ring) index.push(at, at - sectors, next, next, at - sectors, next - sectors);
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setIndex(index);
  return geometry;
}
