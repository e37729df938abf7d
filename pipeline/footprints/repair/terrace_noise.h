// How exactly a row was mapped, and how much of each building is meant to be square.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace blockrand::repair {

inline constexpr double kLeastNoise = 0.004;   // m. OSM's grid of 11 mm has a standard deviation of 3 mm
inline constexpr double kLargestNoise = 0.16;  // m. Walls off by more than half a metre are no slips of a mapper's hand

/// A wall's sideways deviation from its building's frame.
struct Deviation {
  double off = 0;     ///< m, at least 0, as if one corner of weight 1 had it all: sine of the angle times sqrt(weight)
  double weight = 1;  ///< m², of its line: what the sine was multiplied with, squared
  double count = 1;   ///< how much of a wall this is: walls of two buildings deviate from two frames
  std::uint32_t building = 0;  ///< ascending
};

struct TerraceNoise {
  double noise = kLargestNoise;  ///< m, standard deviation of a corner's coordinate in one footprint
  std::vector<double> share;     ///< per building, (0, 1): of its walls that belong to its frame, if only about
  double slight = 0;             ///< of these, in the whole row: that are truly a little off
  double likelihood = 0;         ///< logarithm, up to a constant; compares fits of the same walls
};

/// Fits a mixture to a row. Walls of a frame deviate normally, by the noise of the whole row; some are truly off by a
/// degree or two (party walls of bent rows), by an angle whose effect grows with their length; others belong to no
/// frame and are off by any angle, more often by a small one, in a share of each building's own. EM that starts from
/// `noise` metres (McLachlan & Peel, Finite Mixture Models, 2000, ch. 7); rows in which most walls are off keep a small
/// noise so. The likelihood counts what mappers usually do, and that `frames` frames were fitted to the same walls.
/// Where few walls tell, the noise is raised by its uncertainty. Within kLeastNoise and kLargestNoise.
TerraceNoise fit_noise(std::span<const Deviation> deviations, std::size_t buildings, std::size_t frames, double noise);

/// How many times likelier than not a wall belongs to a frame exactly, if it does not deviate from it at all.
double odds_of_frame(const TerraceNoise& row, std::size_t building, double weight);

}  // namespace blockrand::repair
