// When a building was built, in the words of mappers. A pure function: text in, years out, nothing when the text cannot
// be understood.
#pragma once

#include <optional>
#include <string_view>

#include "pipeline/model/style.h"

namespace blockrand::importers::osm {

/// What is outside is a slip of the pen, or a date that no house we could build has.
inline constexpr int kFirstConstructionYear = 500, kLastConstructionYear = 2100;

/// Years. How far `before 1914` and `after 1918` reach. Mappers write them where an old map shows the house (or does
/// not yet): the survey before it is half a century older at most (Prussia's 1:25,000 sheets of 1830-65, 1870-90 and
/// their later editions).
inline constexpr int kOpenEndYears = 50;

/// Nothing that stands was built after it: where `after 2010` ends.
inline constexpr int kLatestOpenEnd = 2030;

/// Years to both sides that `~1890` allows. A mapper who knows less writes the decade.
inline constexpr int kCircaYears = 5;

/// The years of `start_date` and its kin (https://wiki.openstreetmap.org/wiki/Key:start_date), both ends included, and
/// how likely it is that the building was built in them (estimates: a form that says much may be wrong more often, an
/// open end is a guess of ours):
///
/// | form                                           | years                               | confidence |
/// |------------------------------------------------|-------------------------------------|------------|
/// | `1890`, `1890-05`, `1890-05-01`, `1890/05/01`, `01.05.1890`, `May 1890` | 1890       | 0.95       |
/// | `1895..1902`, `1895-1902`, `1871/1914`, `1895 to 1902`, `1938/39`, `mid C17..late C17` | both ends | 0.9 |
/// | `1880s`, `1880er`                              | 1880..1889                          | 0.85       |
/// | `1900s`                                        | 1900..1909; may mean the century    | 0.5        |
/// | `early 1920s`, `mid 1920s`, `late 1920s`       | 1920..1922, 1923..1926, 1927..1929  | 0.8        |
/// | `C19`, `19th century`, `19. Jahrhundert`       | 1801..1900                          | 0.8        |
/// | `early C19`, `mid C19`, `late C19`             | 1801..1833, 1834..1867, 1868..1900  | 0.75       |
/// | `~`, `c.`, `ca.`, `circa`, `around`, `um` before any of them | a year: 5 more to both sides; else a quarter of the
/// period, at least 5 | times 0.85 | | `before 1914`, `<1914`                         | 1864..1913 | 0.5        | |
/// `after 1918`, `>1918`                          | 1919..1968, no later than 2030      | 0.5        | | `<=1914`,
/// `until 1914`, `..1914`, `>=1918`, `since 1918`, `1918..` | with the year itself | 0.5      | | `1889?` | | times 0.7
/// | | `1890;1905`                                    | of a list the first                 | times 0.85 |
///
/// `before` and `after` a decade or a century is before and after all of it, of a range (`after 1939..1945`) after its
/// beginning and before its end. Blanks, underscores and upper or lower case do not matter.
/// Empty for dates before 500 or after 2100, for those of another calendar (`j:1700-01-01`, `jd:2455511`), before
/// Christ, for ranges that run backwards, and for prose.
std::optional<model::ConstructionDate> parse_construction_date(std::string_view text);

}  // namespace blockrand::importers::osm
