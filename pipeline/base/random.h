// Counter-based random numbers: a value depends on its key alone, never on how many were drawn before
// (ARCHITECTURE.md, law 3).
#pragma once

#include <cstdint>
#include <string_view>

namespace blockrand::base {

/// Finaliser of SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, OOPSLA 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// FNV-1a over the bytes of `text`: the name of a choice as a number.
constexpr std::uint64_t hash_text(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return h;
}

/// 64 random bits for (seed, object, name of the choice). Changing one building re-rolls no other.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t object_key, std::string_view choice) {
  return mix64(mix64(mix64(seed) ^ object_key) ^ hash_text(choice));
}

/// Uniform in [0, 1), a multiple of 2^-53.
constexpr double random_unit(std::uint64_t seed, std::uint64_t object_key, std::string_view choice) {
  return static_cast<double>(random_bits(seed, object_key, choice) >> 11) * 0x1.0p-53;
}

}  // namespace blockrand::base
