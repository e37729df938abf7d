// The build as it streams in: 3d-tiles-renderer chooses tiles and keeps their memory within bounds; near windows come
// and go here.
import { Camera, Group, Matrix4, Mesh, Raycaster, Sphere, Vector3, WebGLRenderer } from 'three';
import { TilesRenderer } from '3d-tiles-renderer/three';
import type { Files } from './files';
import { Frame } from './frame';
import { Glb } from './glb';
import type { Foot } from './ground';
import { Cell, TileModel } from './tile_model';

export interface Limits {
  /** Pixels that a tile may be off before finer ones are loaded. */
  error: number;
  /** Metres within which windows are shown whole. */
  near: number;
  /** Bytes of all tiles; above, those out of sight go. */
  bytes: number;
}

export interface Hit {
  model: TileModel;
  row: number;
  distance: number;
}

export class Model {
  readonly tiles: TilesRenderer;
  readonly models = new Set<TileModel>();
  /** A tile came, went or changed: draw anew. */
  on_change = (_shapes_too: boolean): void => {};
  on_load = (_model: TileModel): void => {};
  on_error = (_message: string): void => {};
  private readonly shown_whole = new Set<Cell>();
  private waiting = 0;
  private stale = true;
  private started = false;

  constructor(
    files: Files,
    frame: Frame,
    path: string,
    private readonly limits: Limits,
  ) {
    this.tiles = new TilesRenderer(files.url(path));
    this.tiles.registerPlugin({
      name: 'BLOCKRAND_TILES',
      fetchData: async (url: string, options: { signal?: AbortSignal }) => {
        const answer = await files.response(url, options.signal);
        return /\.json(\?|$)/.test(url) ? answer : answer.arrayBuffer().then((bytes) => new Response(bytes));
      },
      processTileModel: (scene: Group, tile: { content: { uri: string } }) => this.arrange(scene, tile.content.uri),
      calculateBytesUsed: (_tile: unknown, scene: Group | null) => model_of(scene)?.kept_bytes ?? 0,
    });
    this.tiles.manager.addHandler(/\.gl(tf|b)$/, LOADER as never);
    this.tiles.autoDisableRendererCulling = false;
    this.tiles.errorTarget = limits.error;
    this.tiles.lruCache.maxBytesSize = limits.bytes;
    this.tiles.lruCache.minBytesSize = 0.7 * limits.bytes;
    this.tiles.lruCache.minSize = 200;
    this.tiles.parseQueue.maxJobs = 2;
    frame.from_earth.decompose(this.tiles.group.position, this.tiles.group.quaternion, this.tiles.group.scale);
    this.tiles.group.updateMatrixWorld(true);
    const changed = () => {
      this.stale = true;
      this.on_change(true);
    };
    this.tiles.addEventListener('load-model', ({ scene }) => {
      const model = model_of(scene as Group);
      if (!model) return;
      this.models.add(model);
      this.on_load(model);
      changed();
    });
    this.tiles.addEventListener('dispose-model', ({ scene }) => {
      const model = model_of(scene as Group);
      if (!model) return;
      this.models.delete(model);
      for (const cell of model.cells) this.shown_whole.delete(cell);
      model.dispose();
      changed();
    });
    this.tiles.addEventListener('tile-visibility-change', changed);
    this.tiles.addEventListener('load-root-tileset', () => {
      this.started = true;
      changed();
    });
    this.tiles.addEventListener('load-tileset', changed);
    this.tiles.addEventListener('load-error', ({ error, url }) => {
      this.on_error(
        (error as Error).name === 'Error' && (error as { path?: string }).path
          ? error.message
          : `${decodeURIComponent(String(url)).split('/').slice(-4).join('/')}: ${error.message}`,
      );
      changed();
    });
  }

  watch(camera: Camera, renderer: WebGLRenderer): void {
    this.tiles.setCamera(camera);
    this.tiles.setResolutionFromRenderer(camera, renderer);
  }

  /** Lets tiles come and go for the camera. moved: it is elsewhere than at the last call. */
  update(camera: Camera, moved: boolean): void {
    if (!moved && !this.stale && this.settled) return;
    this.stale = false;
    camera.updateMatrixWorld();
    this.tiles.update();
    this.exchange_details(camera.position);
  }

  /** All that the camera sees is there. */
  get settled(): boolean {
    const { downloading, parsing, queued } = (this.tiles as unknown as { stats: Record<string, number> }).stats;
    return this.started && !downloading && !parsing && !queued && this.waiting === 0;
  }

  get shown(): TileModel[] {
    const found: TileModel[] = [];
    for (const tile of this.tiles.visibleTiles) {
      const model = model_of((tile as unknown as { engineData?: { scene?: Group } }).engineData?.scene ?? null);
      if (model) found.push(model);
    }
    return found;
  }

  /** Bytes of tiles, near windows included. */
  get bytes(): number {
    let whole = 0;
    for (const cell of this.shown_whole) whole += bytes_of(cell.whole);
    return (this.tiles.lruCache as unknown as { cachedBytes: number }).cachedBytes + whole;
  }

  /** The place of the whole tileset in the page's frame, or null before it is known. */
  sphere(): Sphere | null {
    const sphere = new Sphere();
    if (!this.tiles.getBoundingSphere(sphere)) return null;
    return sphere.applyMatrix4(this.tiles.group.matrixWorld);
  }

  hit(ray: Raycaster): Hit | null {
    const meshes: Mesh[] = [];
    for (const model of this.shown) {
      if (model.body) meshes.push(model.body);
      for (const cell of model.cells) meshes.push(cell.coarse);
    }
    const first = ray.intersectObjects(meshes, false)[0];
    if (!first?.face) return null;
    const { geometry, userData } = first.object as Mesh;
    const model: TileModel = userData.model;
    const row = geometry.getAttribute('feature').getX(first.face.a);
    return row < model.table.count ? { model, row, distance: first.distance } : null;
  }

  /** The building among the loaded tiles, the finest first. */
  find(building: string): { model: TileModel; rows: number[] } | null {
    const shown = this.shown;
    for (const model of [...shown, ...this.models]) {
      const rows = model.rows_of.get(building);
      if (rows) return { model, rows };
    }
    return null;
  }

  /** The middle of a building's foot and its height in the page's frame. */
  place(model: TileModel, rows: number[]): { foot: Vector3; height: number } {
    let low = Infinity,
      high = -Infinity;
    const middle = new Vector3();
    let parts = 0;
    for (const row of rows) {
      const [x, y, z, top] = model.extents.subarray(4 * row, 4 * row + 4) as unknown as [
        number,
        number,
        number,
        number,
      ];
      if (!Number.isFinite(x + y + z + top)) continue;
      low = Math.min(low, y);
      high = Math.max(high, top);
      middle.add(new Vector3(x, 0, z));
      ++parts;
    }
    middle.divideScalar(Math.max(1, parts)).setY(parts ? low : 0);
    return { foot: middle.applyMatrix4(this.matrix_of(model)), height: parts ? high - low : 10 };
  }

  /** Where a tile's buildings stand, in the page's frame. */
  feet(model: TileModel): Foot[] {
    const matrix = this.matrix_of(model);
    return model.feet.map(({ box: [west, north, east, south], y }) => {
      const at = new Vector3((west + east) / 2, y, (north + south) / 2).applyMatrix4(matrix);
      return {
        x: at.x,
        z: at.z,
        half_x: (east - west) / 2,
        half_z: (south - north) / 2,
        above: at.y - Frame.ground_at(at.x, at.z),
      };
    });
  }

  /** From the tile's frame to the page's, whether the tile hangs in the scene or not. */
  private matrix_of(model: TileModel): Matrix4 {
    const own = model.group.parent!;
    own.updateMatrix();
    return new Matrix4().multiplyMatrices(this.tiles.group.matrixWorld, own.matrix);
  }

  private arrange(scene: Group, uri: string): void {
    const glb: Glb | undefined = scene.userData.glb;
    if (!glb) return;
    delete scene.userData.glb;
    const model = new TileModel(glb, tile_name(uri));
    scene.userData.model = model;
    scene.add(model.group);
  }

  private exchange_details(eye: Vector3): void {
    const { near } = this.limits;
    const wanted: { cell: Cell; distance: number }[] = [];
    const visible = new Set(this.shown);
    const sphere = new Sphere();
    for (const model of visible) {
      if (!model.cells.length) continue;
      for (const cell of model.cells) {
        sphere.copy(cell.coarse.geometry.boundingSphere!).applyMatrix4(this.matrix_of(model));
        const distance = Math.max(0, sphere.center.distanceTo(eye) - sphere.radius);
        if (distance < near) wanted.push({ cell, distance });
        else if (distance > 1.3 * near) this.coarsen(cell);
      }
    }
    for (const cell of this.shown_whole) if (!visible.has(cell.tile)) this.coarsen(cell);
    const missing = wanted.filter(({ cell }) => !cell.whole).sort((a, b) => a.distance - b.distance);
    const start = performance.now();
    while (missing.length && performance.now() - start < 12) {
      const cell = missing.shift()!.cell;
      cell.whole = cell.tile.whole_mesh(cell);
      cell.tile.group.add(cell.whole);
      cell.whole.updateMatrixWorld(true);
      cell.coarse.visible = false;
      this.shown_whole.add(cell);
      this.on_change(true);
    }
    this.waiting = missing.length;
    if (missing.length) this.stale = true;
  }

  private coarsen(cell: Cell): void {
    if (!cell.whole) return;
    cell.whole.removeFromParent();
    cell.whole.geometry.dispose();
    cell.whole = null;
    cell.coarse.visible = true;
    this.shown_whole.delete(cell);
    this.on_change(true);
  }
}

/** What the renderer takes for three's GLTFLoader. */
const LOADER = {
  setWithCredentials() {},
  setRequestHeader() {},
  setCrossOrigin() {},
  async parseAsync(bytes: ArrayBuffer): Promise<{ scene: Group }> {
    const scene = new Group();
    scene.userData.glb = await Glb.read(bytes);
    return { scene };
  },
};

function model_of(scene: Group | null | undefined): TileModel | null {
  return (scene?.userData.model as TileModel | undefined) ?? null;
}

/** "tiles/15/35206/25947_lod2.glb" is of tile 15_35206_25947, pieces of a tile as well. */
function tile_name(uri: string): string {
  const [, level, x, y] = /(\d+)\/(\d+)\/(\d+)[^/]*\.glb/.exec(uri) ?? [];
  return level ? `${level}_${x}_${y}` : uri;
}

function bytes_of(mesh: Mesh | null): number {
  if (!mesh) return 0;
  let bytes = mesh.geometry.index?.array.byteLength ?? 0;
  for (const attribute of Object.values(mesh.geometry.attributes)) bytes += attribute.array.byteLength;
  return bytes;
}
