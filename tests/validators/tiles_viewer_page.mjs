// The page of tiles_viewer.mjs: shows /build/tileset.json and leaves what it saw in window.seen:
//   tiles, meshes, triangles           loaded and shown at the same time
//   errors                             what the renderer could not load
//   outside                            vertices outside of their tile's bounding volume, by the renderer's own check
//   features: {id: {building, box}}    by the metadata; box = [west, south, lowest, east, north, highest], degrees and m
//   untold                             vertices whose feature the metadata does not know
//   drawn                              share of the picture that is not background
//   colours                            number of different colours in it
import * as THREE from 'three';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { TilesRenderer, WGS84_ELLIPSOID } from '3d-tiles-renderer';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/plugins';
import { TilesetValidationPlugin } from '3d-tiles-renderer/src/three/plugins/TilesetValidationPlugin.js';

const BACKGROUND = 0x9fb8cc;
const frame = () => new Promise((next) => requestAnimationFrame(next));

async function show() {
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(innerWidth, innerHeight);
  document.body.append(renderer.domElement);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(BACKGROUND);
  const camera = new THREE.PerspectiveCamera(40, innerWidth / innerHeight, 1, 1e5);

  const errors = [];
  const tiles = new TilesRenderer('/build/tileset.json');
  tiles.registerPlugin(new GLTFExtensionsPlugin({ metadata: true, meshoptDecoder: MeshoptDecoder }));
  tiles.registerPlugin(new TilesetValidationPlugin());
  tiles.addEventListener('load-error', ({ error, url }) => errors.push(`${url}: ${error}`));
  tiles.errorTarget = 0;
  tiles.lruCache.maxSize = tiles.lruCache.minSize = 1e5;
  tiles.lruCache.minBytesSize = tiles.lruCache.maxBytesSize = 4e9;
  scene.add(tiles.group);
  tiles.setCamera(camera);
  tiles.setResolutionFromRenderer(camera, renderer);

  // From the south, look down at the middle of the whole: everything is in view, so everything is to be loaded.
  const sphere = new THREE.Sphere();
  const middle = {};
  const east = new THREE.Vector3(), north = new THREE.Vector3(), up = new THREE.Vector3();
  const aim = (distance, pitch) => {
    WGS84_ELLIPSOID.getPositionToCartographic(sphere.center, middle);
    WGS84_ELLIPSOID.getEastNorthUpAxes(middle.lat, middle.lon, east, north, up);
    camera.position.copy(sphere.center).addScaledVector(up, distance * Math.sin(pitch))
      .addScaledVector(north, -distance * Math.cos(pitch));
    camera.up.copy(up);
    camera.near = distance / 100;
    camera.far = distance * 4;
    camera.lookAt(sphere.center);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  };
  camera.position.set(0, 0, 2e7);
  camera.far = 1e8;
  camera.updateProjectionMatrix();
  while (!tiles.getBoundingSphere(sphere)) {
    if (errors.length) return { errors };
    tiles.update();
    await frame();
  }
  aim(sphere.radius / Math.sin((camera.fov / 2) * (Math.PI / 180)), Math.PI / 3);
  // Done when nothing was under way for some frames: a tile that arrives can ask for its children.
  for (let quiet = 0; quiet < 20; ) {
    camera.updateMatrixWorld();
    tiles.update();
    await frame();
    const { downloading, parsing, queued = 0 } = tiles.stats;
    quiet = downloading + parsing + queued === 0 ? quiet + 1 : 0;
  }

  // ---- what is loaded, in Earth-centred coordinates by the scene's own matrices (doubles)
  const seen = { tiles: tiles.visibleTiles.size, meshes: 0, triangles: 0, errors, untold: 0, features: {} };
  tiles.group.updateMatrixWorld(true);
  const point = new THREE.Vector3(), place = {};
  const box = new THREE.Box3();
  const to_degrees = 180 / Math.PI;
  tiles.group.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const { geometry } = mesh;
    const positions = geometry.getAttribute('position');
    ++seen.meshes;
    seen.triangles += (geometry.index ? geometry.index.count : positions.count) / 3;
    const info = mesh.userData.meshFeatures?.getFeatureInfo()[0];
    const ids = info && geometry.getAttribute(`_feature_id_${info.attribute}`);
    const rows = new Map();
    for (let i = 0; i < positions.count; ++i) {
      point.fromBufferAttribute(positions, i).applyMatrix4(mesh.matrixWorld);
      box.expandByPoint(point);
      WGS84_ELLIPSOID.getPositionToCartographic(point, place);
      const lon = place.lon * to_degrees, lat = place.lat * to_degrees;
      if (!ids) {
        ++seen.untold;
        continue;
      }
      const id = ids.getX(i);
      if (!rows.has(id)) {
        const row = mesh.userData.structuralMetadata.getPropertyTableData([info.propertyTable], [id])[0];
        rows.set(id, (seen.features[row.id] ??= { building: row.building, box: [lon, lat, place.height, lon, lat, place.height] }));
      }
      const b = rows.get(id).box;
      b[0] = Math.min(b[0], lon), b[1] = Math.min(b[1], lat), b[2] = Math.min(b[2], place.height);
      b[3] = Math.max(b[3], lon), b[4] = Math.max(b[4], lat), b[5] = Math.max(b[5], place.height);
    }
  });

  // ---- the picture: closer, in sunlight from the south-west
  box.getBoundingSphere(sphere);
  aim((sphere.radius / Math.sin((camera.fov / 2) * (Math.PI / 180))) * 0.68, Math.PI / 5);
  const sun = new THREE.DirectionalLight(0xfff4e0, 2.6);
  sun.position.copy(sphere.center).addScaledVector(up, 800).addScaledVector(east, -700).addScaledVector(north, -300);
  sun.target.position.copy(sphere.center);
  const sky = new THREE.HemisphereLight(0xdfeaf5, 0x8a8272, 1.4);
  sky.position.copy(up);
  scene.add(sun, sun.target, sky);
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const counts = new Map();
  for (let i = 0; i < pixels.length; i += 4) {
    const colour = (pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2];
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  seen.drawn = 1 - (counts.get(BACKGROUND) ?? 0) / (pixels.length / 4);
  seen.colours = counts.size;
  return seen;
}

show().then(
  (seen) => (window.seen = seen),
  (error) => (window.seen = { errors: [String(error?.stack ?? error)] }),
);
