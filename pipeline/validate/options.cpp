#include "pipeline/validate/options.h"

#include "pipeline/base/option.h"

namespace blockrand::validate {

base::OptionTable<ValidateOptions> validate_options() {
  using V = ValidateOptions;
  return {
      base::text({.name = "extract",
                  .argument = "FILE",
                  .type = base::OptionType::path,
                  .commands = base::kValidate,
                  .help = "the extract that the build was made from, where it is no longer where build.json says"},
                 &V::extract),
      base::text({.name = "schemas",
                  .argument = "FOLDER",
                  .type = base::OptionType::folder,
                  .commands = base::kValidate,
                  .help = "also check CityGML against the OGC schemas here: citygml2.xsd, and catalog.xml that says "
                          "where the others are"},
                 &V::schemas),
      base::integer({.name = "sample",
                     .argument = "N",
                     .commands = base::kValidate,
                     .minimum = 1,
                     .maximum = 1000000,
                     .help = "read only every Nth tile; counts are then not compared"},
                    &V::sample)};
}

}  // namespace blockrand::validate
