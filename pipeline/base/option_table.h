// Names the table of a struct's options without its entries, so that headers of option structs stay light (option.h).
#pragma once

#include <vector>

namespace blockrand::base {

struct OptionSection;

template <class Struct>
struct Option;

/// The options of a struct in the order of help and reference. It lies beside the struct and is the only place where an
/// option is declared: command line, config file, help, reference, manual, completion and the record in build.json
/// follow from it.
template <class Struct>
using OptionTable = std::vector<Option<Struct>>;

}  // namespace blockrand::base
