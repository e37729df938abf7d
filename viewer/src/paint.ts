// The material of all houses: three's Lambert shading with colours by feature, glass that mirrors the sky, and darker
// feet.
import { Color, DataTexture, DoubleSide, FrontSide, MeshLambertMaterial } from 'three';

/** What all tiles share: changed in place, so that a change shows everywhere at once. */
export const PAINT = {
  sky_zenith: { value: new Color() },
  sky_horizon: { value: new Color() },
  sun_colour: { value: new Color() },
  sun_direction: { value: [0, 1, 0] },
  highlight: { value: new Color('#ff5310') },
  lamps: { value: 0 },
  /** Stripes of the chosen house per pixel of the picture. */
  hatching: { value: 1 / 14 },
  /** Metres that walls go into the ground, where it is no plane. */
  sunk: { value: 0 },
};

// Marks of a feature's texel: alpha. With colours, rgb is the square root of linear light, as in vertices.
export const MARK = { plain: 0, coloured: 85, chosen: 170, chosen_coloured: 255 } as const;

const VERTEX_HEAD = /* glsl */ `
attribute vec4 paint;
attribute vec2 feature;
uniform highp sampler2D features;
uniform float sunk;
varying vec3 v_paint;
varying vec3 v_world;
varying vec3 v_facing;
varying float v_above;
flat varying float v_kind;
flat varying vec4 v_feature;
`;
const VERTEX_BODY = /* glsl */ `
v_paint = paint.rgb * paint.rgb;
v_kind = floor(paint.a * 3.0 + 0.5);
v_above = feature.y * 0.01;
if (v_kind < 0.5 && feature.y < 0.5) transformed.y -= sunk;
v_world = (modelMatrix * vec4(position, 1.0)).xyz;
v_facing = mat3(modelMatrix) * normal;
int texel = int(feature.x);
ivec2 texels = textureSize(features, 0);
v_feature = texel < texels.x * texels.y ? texelFetch(features, ivec2(texel % texels.x, texel / texels.x), 0) : vec4(0.0);
`;
const FRAGMENT_HEAD = /* glsl */ `
varying vec3 v_paint;
varying vec3 v_world;
varying vec3 v_facing;
varying float v_above;
flat varying float v_kind;
flat varying vec4 v_feature;
uniform vec3 sky_zenith;
uniform vec3 sky_horizon;
uniform vec3 sun_colour;
uniform vec3 sun_direction;
uniform vec3 highlight;
uniform float lamps;
uniform float hatching;
`;
// Coloured: bodies take the colour, with a little of their own light and dark, so that walls and roofs stay apart;
// ornaments take a pale tint of it, glass stays glass.
const FRAGMENT_COLOUR = /* glsl */ `
// Colours of whole houses look stronger than those of a sample: a little weaker, as through air.
vec3 shown = mix(vec3(dot(v_paint, vec3(0.2126, 0.7152, 0.0722))), v_paint, 0.86);
bool is_glass = v_kind > 1.5 && v_kind < 2.5;
float marks = v_feature.a * 3.0;
bool chosen = marks > 1.5;
bool coloured = (marks > 0.5 && marks < 1.5) || marks > 2.5;
if (coloured && !is_glass) {
  float own = sqrt(dot(v_paint, vec3(0.2126, 0.7152, 0.0722)));
  vec3 given = v_feature.rgb * v_feature.rgb;
  shown = v_kind < 0.5 ? given * (0.72 + 0.4 * own) : mix(given, vec3(0.85), 0.1 + 0.16 * own);
}
if (coloured && is_glass) shown = vec3(0.05, 0.06, 0.07);
// The chosen house keeps its colour in a legend's colours and is hatched, which every eye can tell.
if (chosen && !is_glass) {
  vec3 stripe = dot(shown, vec3(0.2126, 0.7152, 0.0722)) > 0.3 ? vec3(0.012) : vec3(1.0);
  if (coloured) shown = mix(shown, stripe, step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) * hatching)) * 0.85);
  else shown = mix(shown, highlight, 0.62);
}
// Light from the sky reaches the foot of a wall less than its top.
float open = mix(0.66, 1.0, smoothstep(-0.5, 9.0, v_above));
diffuseColor.rgb = shown * open;
`;
const FRAGMENT_LIGHT = /* glsl */ `
vec3 facing_out = normalize(v_facing);
if (is_glass) {
  vec3 look = normalize(v_world - cameraPosition);
  vec3 mirrored = reflect(look, facing_out);
  float grazing = pow(1.0 - clamp(dot(-look, facing_out), 0.0, 1.0), 4.0);
  vec3 sky = mirrored.y > 0.0 ? mix(sky_horizon, sky_zenith, pow(mirrored.y, 0.55)) : sky_horizon * 0.32;
  sky = mix(sky_horizon * 0.32, sky, smoothstep(-0.06, 0.1, mirrored.y));
  vec3 glint = sun_colour * pow(max(dot(mirrored, sun_direction), 0.0), 240.0) * 3.0;
  outgoingLight = outgoingLight * 0.55 + sky * (0.16 + 0.64 * grazing) + glint;
  // At night some rooms are lit: the same ones each night.
  float room = fract(sin(dot(floor(v_world / vec3(3.1, 3.4, 3.1)), vec3(12.9898, 78.233, 37.719))) * 43758.5453);
  outgoingLight += lamps * step(0.62, room) * vec3(0.95, 0.62, 0.26) * (0.5 + 0.5 * room);
}
if (chosen && !coloured) outgoingLight += highlight * 0.12;
`;

/** A material whose houses take their colours from `features`, a texel of MARK and colour for each row of the table. */
export function painted_material(features: DataTexture): MeshLambertMaterial {
  const material = new MeshLambertMaterial({ side: FrontSide, shadowSide: DoubleSide });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, PAINT, { features: { value: features } });
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>${VERTEX_HEAD}`)
      .replace('#include <begin_vertex>', `#include <begin_vertex>${VERTEX_BODY}`);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>${FRAGMENT_HEAD}`)
      .replace('#include <color_fragment>', FRAGMENT_COLOUR)
      .replace('#include <opaque_fragment>', `${FRAGMENT_LIGHT}#include <opaque_fragment>`);
  };
  material.customProgramCacheKey = () => 'blockrand-paint';
  return material;
}

/** Writes a texel. colour: sRGB, or null for as built. */
export function paint_texel(texels: Uint8Array, row: number, colour: Color | null, chosen: boolean): void {
  const at = 4 * row;
  if (colour) {
    texels[at] = Math.round(255 * Math.sqrt(colour.r));
    texels[at + 1] = Math.round(255 * Math.sqrt(colour.g));
    texels[at + 2] = Math.round(255 * Math.sqrt(colour.b));
  }
  texels[at + 3] = colour ? (chosen ? MARK.chosen_coloured : MARK.coloured) : chosen ? MARK.chosen : MARK.plain;
}
