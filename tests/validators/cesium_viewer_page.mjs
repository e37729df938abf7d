// The page of tiles_viewer.mjs for CesiumJS: shows /build/tileset.json without globe, imagery or Ion and leaves what it saw in
// window.seen:
//   version                            of CesiumJS
//   tiles                              shown when everything was loaded
//   errors                             what could not be loaded
//   sphere                             bounding sphere of the tileset: [longitude, latitude, height, radius], degrees and m
//   features: {id: {name: value}}      every feature that is shown, by the metadata
//   picked: [[name, value]]            what a click on a house tells, in the order in which the viewer lists it
//   drawn                              share of the picture that is not background
//   colours                            number of different colours in it
const { Cesium } = window;
const frame = () => new Promise((next) => requestAnimationFrame(next));

function pixels_of(canvas) {
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  return context.getImageData(0, 0, copy.width, copy.height).data;
}

/** Name and value of each property of a feature, in the order of the viewer. */
const properties = (feature) => feature.getPropertyIds().map((name) => [name, feature.getProperty(name)]);

async function show() {
  Cesium.Ion.defaultAccessToken = '';
  const holder = document.createElement('div');
  holder.style.cssText = `width:${innerWidth}px;height:${innerHeight}px`;
  document.body.append(holder);
  // What the style sheet of the package's widgets does for the picture.
  const style = document.createElement('style');
  style.textContent = '.cesium-widget, .cesium-widget canvas { width: 100%; height: 100%; display: block }';
  document.head.append(style);
  const widget = new Cesium.CesiumWidget(holder, {
    baseLayer: false, globe: false, skyBox: false, skyAtmosphere: false, scene3DOnly: true, showRenderLoopErrors: false, msaaSamples: 1,
    creditContainer: document.createElement('div'),
    contextOptions: { webgl: { preserveDrawingBuffer: true } },
  });
  const { scene } = widget;
  const errors = [];
  scene.renderError.addEventListener((_, error) => errors.push(String(error)));
  scene.backgroundColor = Cesium.Color.fromCssColorString('#9fb8cc');
  scene.sun && (scene.sun.show = false);
  scene.moon && (scene.moon.show = false);
  scene.fog.enabled = false;

  const tileset = await Cesium.Cesium3DTileset.fromUrl('/build/tileset.json', {
    maximumScreenSpaceError: 0.001, skipLevelOfDetail: false, cullRequestsWhileMoving: false, cacheBytes: 4e9,
  });
  tileset.environmentMapManager.enabled = false;
  const shown = new Set();
  tileset.tileFailed.addEventListener(({ url, message }) => errors.push(`${url}: ${message}`));
  tileset.tileVisible.addEventListener((tile) => shown.add(tile));
  scene.primitives.add(tileset);

  const { center, radius } = tileset.boundingSphere;
  const place = Cesium.Cartographic.fromCartesian(center);
  const degrees = Cesium.Math.toDegrees;
  const sphere = [degrees(place.longitude), degrees(place.latitude), place.height, radius];
  // Light from the south-west, half up.
  const axes = Cesium.Transforms.eastNorthUpToFixedFrame(center);
  const towards = Cesium.Matrix4.multiplyByPointAsVector(axes, new Cesium.Cartesian3(0.55, 0.6, -0.6), new Cesium.Cartesian3());
  scene.light = new Cesium.DirectionalLight({ direction: Cesium.Cartesian3.normalize(towards, towards), intensity: 3.0 });
  const aim = (pitch, distance) =>
    widget.camera.lookAt(center, new Cesium.HeadingPitchRange(0, Cesium.Math.toRadians(pitch), distance * radius));
  aim(-60, 2.6);
  // Done when nothing was under way for some frames: a tile that arrives can ask for its children.
  for (let quiet = 0; quiet < 4; ) {
    await frame();
    quiet = tileset.tilesLoaded ? quiet + 1 : 0;
    if (errors.length) return { errors };
  }
  shown.clear();
  await frame();
  await frame();
  const features = {};
  for (const { content } of shown)
    for (let i = 0; i < content.featuresLength; ++i) {
      const feature = Object.fromEntries(properties(content.getFeature(i)));
      features[feature.id] = feature;
    }
  const tiles = shown.size;

  // A click on whatever house is nearest to the middle of the picture.
  aim(-36, 1.5);
  for (let quiet = 0; quiet < 2; ) {
    await frame();
    quiet = tileset.tilesLoaded ? quiet + 1 : 0;
  }
  let picked = null;
  for (let ring = 0; ring < 12 && !picked; ++ring)
    for (let turn = 0; turn < 8 && !picked; ++turn) {
      const at = new Cesium.Cartesian2(innerWidth / 2 + 30 * ring * Math.cos(turn * 0.785), innerHeight / 2 + 30 * ring * Math.sin(turn * 0.785));
      const feature = scene.pick(at);
      if (feature instanceof Cesium.Cesium3DTileFeature) picked = properties(feature);
    }
  scene.render();
  const pixels = pixels_of(scene.canvas);
  const counts = new Map();
  for (let i = 0; i < pixels.length; i += 4) {
    const colour = (pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2];
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  const drawn = 1 - Math.max(...counts.values()) / (pixels.length / 4);
  widget.useDefaultRenderLoop = false;
  return { version: Cesium.VERSION, tiles, errors, sphere, features, picked, drawn, colours: counts.size };
}

show().then(
  (seen) => (window.seen = seen),
  (error) => (window.seen = { errors: [String(error?.stack ?? error)] }),
);
