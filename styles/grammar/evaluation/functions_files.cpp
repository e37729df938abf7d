// Files and assets. Where there are none, answers are placeholders that let rule files run
// (docs/rule_language.md §2.2).
#include <algorithm>

#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/evaluation/text_list.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

constexpr std::string_view kPlaceholder = "placeholder";

/// What a query finds; without a finding the one placeholder.
tl::expected<std::vector<std::string>, std::string> search(const std::string& query, const FunctionContext& context) {
  tl::expected<std::vector<std::string>, std::string> found;
  if (context.files != nullptr && context.files->search) found = context.files->search(query);
  if (found && found->empty()) found->emplace_back(kPlaceholder);
  return found;
}
/// The first argument that is a text: the query of asset functions, wherever it stands.
std::string query_of(Arguments a) {
  for (const Value& value : a)
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return {};
}

std::size_t name_start(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? 0 : slash + 1;
}
/// The dot before the extension; the end where there is none.
std::size_t extension_dot(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos || dot < name_start(path) ? path.size() : dot;
}

FunctionResult directory(Arguments a, FunctionContext&) { return Value(text(a[0]).substr(0, name_start(text(a[0])))); }
FunctionResult file_name(Arguments a, FunctionContext&) { return Value(text(a[0]).substr(name_start(text(a[0])))); }
FunctionResult stem(Arguments a, FunctionContext&) {
  const std::size_t from = name_start(text(a[0]));
  return Value(text(a[0]).substr(from, extension_dot(text(a[0])) - from));
}
FunctionResult extension(Arguments a, FunctionContext&) {
  const std::size_t dot = extension_dot(text(a[0]));
  return Value(dot < text(a[0]).size() ? text(a[0]).substr(dot + 1) : std::string());
}

FunctionResult exists(Arguments a, FunctionContext& context) {
  return Value(context.files != nullptr && context.files->exists && context.files->exists(text(a[0])));
}
FunctionResult found_list(Arguments a, FunctionContext& context) {
  const auto found = search(query_of(a), context);
  if (!found) return failure(found.error());
  std::string out;
  for (const std::string& path : *found) out.append(path).push_back(';');
  return Value(std::move(out));
}
FunctionResult found_array(Arguments a, FunctionContext& context) {
  auto found = search(query_of(a), context);
  if (!found) return failure(found.error());
  const std::size_t count = found->size();
  return Value(TextArray{std::move(*found), count});
}
FunctionResult found_any(Arguments a, FunctionContext& context) {
  const auto found = search(query_of(a), context);
  if (!found) return failure(found.error());
  return Value((*found)[static_cast<std::size_t>(context.draw() * static_cast<double>(found->size()))]);
}
FunctionResult found_first(Arguments a, FunctionContext& context) {
  const auto found = search(query_of(a), context);
  if (!found) return failure(found.error());
  return Value(found->front());
}

std::string contents(const std::string& path, FunctionContext& context) {
  if (context.files != nullptr && context.files->read)
    if (auto read = context.files->read(path)) return std::move(*read);
  context.warn("there is no file '" + path + "'; an empty one is taken");
  return {};
}
/// Comma-separated values; quoted fields may hold commas, quotes (doubled) and line ends.
tl::expected<TextArray, std::string> table(const std::string& in) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row;
  std::string field;
  bool quoted = false, any = false;
  const auto end_field = [&] { row.push_back(std::move(field)), field.clear(); };
  const auto end_row = [&] {
    if (any) end_field(), rows.push_back(std::move(row));
    row.clear();
    any = false;
  };
  for (std::size_t i = 0; i < in.size(); ++i) {
    const char c = in[i];
    if (quoted) {
      if (c != '"')
        field += c;
      else if (i + 1 < in.size() && in[i + 1] == '"')
        field += in[++i];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = any = true;
    } else if (c == ',') {
      any = true;
      end_field();
    } else if (c == '\n') {
      end_row();
    } else if (c != '\r') {
      any = true;
      field += c;
    }
  }
  end_row();
  TextArray out;
  for (const auto& r : rows) out.columns = std::max(out.columns, r.size());
  if (out.columns * rows.size() > kMostArrayItems) return failure("the table has too many cells");
  for (auto& r : rows) {
    r.resize(out.columns);
    std::move(r.begin(), r.end(), std::back_inserter(out.items));
  }
  return out;
}
FunctionResult text_file(Arguments a, FunctionContext& context) { return Value(contents(text(a[0]), context)); }
FunctionResult text_table(Arguments a, FunctionContext& context) {
  auto read = table(contents(text(a[0]), context));
  if (!read) return failure(read.error());
  return Value(std::move(*read));
}
FunctionResult number_table(Arguments a, FunctionContext& context) {
  const auto read = table(contents(text(a[0]), context));
  if (!read) return failure(read.error());
  NumberArray out{{}, read->columns};
  for (const std::string& cell : read->items) out.items.push_back(leading_number(cell));
  return Value(std::move(out));
}

FunctionResult asset_info(Arguments a, FunctionContext& context) {
  AssetBox box;  // sizes 1, offsets 0
  if (context.files != nullptr && context.files->asset) box = context.files->asset(text(a[0])).value_or(box);
  const std::string& part = text(a[1]);
  if (part.size() == 2 && part[1] >= 'x' && part[1] <= 'z') {
    const Vector3& v = part[0] == 's' ? box.size : box.offset;
    if (part[0] == 's' || part[0] == 't') return Value(part[1] == 'x' ? v.x : part[1] == 'y' ? v.y : v.z);
  }
  return failure("'" + part + "' is none of sx sy sz tx ty tz");
}
FunctionResult image_info(Arguments a, FunctionContext& context) {
  Vector2 size{1, 1};
  if (context.files != nullptr && context.files->image) size = context.files->image(text(a[0])).value_or(size);
  if (text(a[1]) == "sx") return Value(size.x);
  if (text(a[1]) == "sy") return Value(size.y);
  return failure("'" + text(a[1]) + "' is none of sx sy");
}
FunctionResult no_text(Arguments, FunctionContext&) { return Value(std::string()); }
FunctionResult no_texts(Arguments, FunctionContext&) { return Value(TextArray{}); }

}  // namespace

std::span<const FunctionEntry> file_functions() {
  static constexpr FunctionEntry kTable[] = {
      {"assetApproxRatio", "a+", found_first},
      {"assetApproxSize", "a+", found_first},
      {"assetBestRatio", "a+", found_first},
      {"assetBestSize", "a+", found_first},
      {"assetFitSize", "a+", found_first},
      {"assetInfo", "ss", asset_info},
      {"assetMetadata", "a+", no_text},
      {"assetNamingInfo", "a+", no_text},
      {"assetsSortRatio", "a+", found_list},
      {"assetsSortSize", "a+", found_list},
      {"fileBasename", "s", stem},
      {"fileDirectory", "s", directory},
      {"fileExists", "s", exists},
      {"fileExtension", "s", extension},
      {"fileName", "s", file_name},
      {"fileRandom", "s", found_any},
      {"fileSearch", "s", found_list},
      {"filesSearch", "s", found_array},
      {"getMaterial", "ss", no_texts},
      {"imageApproxRatio", "a+", found_first},
      {"imageBestRatio", "a+", found_first},
      {"imageInfo", "ss", image_info},
      {"imagesSortRatio", "a+", found_list},
      {"readFloatTable", "s", number_table},
      {"readMaterial", "a+", no_texts},
      {"readStringTable", "s", text_table},
      {"readTextFile", "s", text_file},
  };
  return kTable;
}

}  // namespace blockrand::grammar
