#include "pipeline/observation/options.h"

#include "pipeline/base/option.h"

namespace blockrand::observation {
namespace {

using base::OptionType;
using base::RecordValue;
using I = ImageryOptions;

const base::Choices<Correction> kCorrections = {
    {"off", Correction::off}, {"report", Correction::report}, {"apply", Correction::apply}};

std::vector<std::string> paths(const I& options) {
  std::vector<std::string> all;
  for (const importers::imagery::ImageSource& image : options.images) all.push_back(image.path);
  return all;
}

base::Option<I> refine_option() {
  base::Option<I> option =
      base::number<I>({.name = "imagery-refine",
                       .key = "imagery_refine",
                       .argument = "METRES",
                       .minimum = 0,
                       .maximum = kMostRefineWithin,
                       .help = "how far single walls are looked for beside where their house stands (told or moved as "
                               "--imagery-correct says); 0: they are not",
                       .record = base::OptionRecord::yes},
                      &I::refine);
  option.recorded = [number = option.recorded](const I& o) { return o.images.empty() ? std::nullopt : number(o); };
  return option;
}

}  // namespace

// A tile that is built alone takes what the build of the whole found (imagery.json), not these. A build without images has no record of them: its bytes are those of programs that knew none.
base::OptionTable<ImageryOptions> imagery_options() {
  return {
      base::custom<I>(
          {.name = "imagery",
           .argument = "PATH",
           .type = OptionType::path,
           .help = "an aerial image: any raster that GDAL reads, with pixels of 1 m at most (with date and licence: "
                   "[[image]] in the config file)",
           .several = true,
           .record = base::OptionRecord::yes},
          [](I& o, const std::string& text) {
            o.images.push_back({.path = text, .date = {}, .licence = {}, .attribution = {}});
          },
          [](const I& o) { return base::joined(paths(o), " "); },
          [](const I& o) { return o.images.empty() ? std::nullopt : std::optional(RecordValue(paths(o))); }),
      base::custom<I>(
          {.name = "imagery-correct",
           .key = "imagery_correct",
           .argument = "HOW",
           .help = "outlines that the images show elsewhere: off (nobody looks for them; roofs alone are looked at), "
                   "report (imagery.json tells "
                   "them; nothing is moved), apply (they are moved there)",
           .choices = base::words_of(kCorrections),
           .record = base::OptionRecord::yes},
          [](I& o, const std::string& text) { o.correct = base::choose(text, kCorrections); },
          [](const I& o) { return base::word_of(kCorrections, o.correct); },
          [](const I& o) {
            return o.images.empty() ? std::nullopt : std::optional(RecordValue(base::word_of(kCorrections, o.correct)));
          }),
      refine_option()};
}

}  // namespace blockrand::observation
