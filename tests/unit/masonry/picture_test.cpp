// Draws a front in each bond, to be looked at: MASONRY_PICTURE=file.svg test_masonry --gtest_filter=MasonryPicture.*
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/unit/masonry/masonry_walls.h"

namespace blockrand::masonry {
namespace {

std::string drawn(const Outline& outline, double right, const char* colour) {
  std::string out = "<polygon points=\"";
  for (const auto& p : outline) out += fmt::format("{:.3f},{:.3f} ", p.x + right, 10 - p.y);
  return out + fmt::format("\" fill=\"{}\"/>\n", colour);
}

TEST(MasonryPicture, OfAFrontInEachBond) {
  const char* file = std::getenv("MASONRY_PICTURE");
  if (!file) GTEST_SKIP() << "MASONRY_PICTURE names no file";
  constexpr const char* kColours[] = {"#a5604a", "#b87358", "#6a8f9c", "#c9a24a", "#cfc4a6",
                                      "#e0a020", "#c4b48c", "#b0a890", "#9a8f7c"};
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 70 10\" width=\"7000\" height=\"1000\">\n";
  double right = 0;
  for (const Bond bond : kAllBonds) {
    const WallToLay wall = front_wall();
    svg += drawn(wall.outline, right, "#ded8cc");
    for (const Outline& o : wall.openings) svg += drawn(o, right, "#223344");
    for (const Stone& s : stones_of(wall, usual_masonry(bond)))
      svg += drawn(s.outline, right, kColours[static_cast<int>(s.role)]);
    right += 10;
  }
  std::ofstream(file) << svg << "</svg>\n";
}

}  // namespace
}  // namespace blockrand::masonry
