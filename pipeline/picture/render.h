// Draws a scene: z-buffer, sun with shadows, light of the sky, lines along edges. No graphics card, no browser.
#pragma once

#include "pipeline/model/colour.h"
#include "pipeline/picture/camera.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/scene.h"

namespace blockrand::picture {

struct RenderOptions {
  int width = 1200, height = 800;  ///< pixels
  int supersampling = 2;           ///< samples per pixel along each axis, 1 to 4
  double sun_azimuth = 135;        ///< degrees clockwise from north: where the sun stands
  double sun_elevation = 42;       ///< degrees above the horizon
  double sun_strength = 2.3;       ///< white that faces the sun gets this much light, 1 being white in the picture
  double sky_strength = 0.9;       ///< likewise of white that sees the whole sky
  bool lit = true;                 ///< false: colours as they are, so that a legend holds; lines alone show the form
  bool shadows = true;
  bool sky_occlusion = true;  ///< courtyards and streets are darker than roofs; false: every place sees its half-space
  int sky_directions = 32;    ///< from which the sky is looked for; rounded up to a multiple of supersampling²
  int shadow_map = 3072;      ///< cells along a side of the sun's depth map
  int sky_map = 640;          ///< likewise of each of the sky's
  bool lines = true;          ///< dark lines along silhouettes, creases and borders between objects
  double line_strength = 0.55;  ///< 1: black; less where a pixel covers more than half a metre
  double crease_angle = 20;     ///< degrees between faces from which on their common edge is a line
  model::Colour background{233, 236, 239};
  double ground_fade = 1.1;  ///< the ground fades into the background from this many scene radii on
};

/// The picture that `camera` takes of the scene.
///
/// `occluders`: what takes light of the sky away; null: the scene. A simpler model of a scene with much detail shades it as well: the
/// sky's depth maps have cells of half a metre, and each of them draws all of it.
///
/// Same scene, camera and options → same bytes on every x86-64. One thread; 1200 x 800 with 350,000 triangles seen from both sides take 1.4 s, with 17,000 0.6 s.
/// Memory: 13 bytes a sample, 40 bytes a pixel and one depth map at a time.
/// \throws std::invalid_argument  a size or count that is not positive, or beyond 8192 pixels
Image render(const Scene& scene, const Camera& camera, const RenderOptions& options = {},
             const Scene* occluders = nullptr);

}  // namespace blockrand::picture
