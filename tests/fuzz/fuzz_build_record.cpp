// libFuzzer target: whatever the JSON and the report of a build hold, `validate` reads them or says what is wrong. The
// first byte chooses: 0 build.json, 1 report.json, 2 report.html, 3 explain/index.txt, 4 the records in explain/,
// 5 explain/places.tsv before records.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/validate/build_record.h"
#include "pipeline/validate/explanations.h"
#include "pipeline/validate/report_check.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  using namespace blockrand::validate;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto write = [&](const char* name) { fuzz::write_file(name, data + 1, size - 1); };
  BuildRecord record;
  FindingLog log;
  switch (data[0] % 6) {
    case 0:
      write("build.json");
      if (const auto read = read_build_record(fuzz::folder(), log)) check_file_list(fuzz::folder(), *read, log);
      break;
    case 1:
      write("report.json");
      (void)read_report(fuzz::folder(), record, log);
      break;
    case 2:
      write("report.html");
      (void)check_report_page(fuzz::folder(), record, nullptr, log);
      break;
    case 3:
      (void)read_explanation_index(text, log);
      break;
    case 5: {
      // Places, and records that they are compared with, one file behind the other.
      const std::size_t middle = std::min(text.find("{\"id\""), text.size());
      const auto places = read_places(text.substr(0, middle), log);
      std::vector<Finding> findings;
      const auto of_tile = places.find("15_1_2");
      (void)check_explanations(text.substr(middle), "explain/15_1_2.jsonl.gz", "15_1_2", nullptr, false, {},
                               of_tile == places.end() ? nullptr : &of_tile->second, record, findings);
      break;
    }
    default: {
      std::vector<Finding> findings;
      (void)check_explanations(text, "explain/15_1_2.jsonl.gz", "15_1_2", nullptr, false, {}, nullptr, record,
                               findings);
      break;
    }
  }
  return 0;
}
