// A property table of EXT_structural_metadata, filled row by row.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

class GlbDocument;

/// Columns of one class of features. Add the columns first, then for each row set what is known and call end_row();
/// what was not set in a row holds the column's noData value. Columns without any value are left out of the table
/// (they stay in the class), as the extension allows for properties that are not required.
class PropertyTable {
 public:
  /// In which order files list the columns; programs show them so.
  enum class Order : std::uint8_t { by_name, as_added };
  explicit PropertyTable(Order order) : order_(order) {}

  enum class Kind : std::uint8_t { text, enumeration, int8, int64, float64, unit_interval };

  struct Column {
    std::string name;  ///< property id: [a-zA-Z_][a-zA-Z0-9_]*
    Kind kind = Kind::text;
    std::string description = {};  ///< may be empty
    std::string enum_type = {};    ///< for `enumeration`
    bool required = false;         ///< set in every row; the column then has no noData
    /// What stands for "absent": enumerations give the value's name as well. Texts always use the empty string.
    std::optional<double> no_data = std::nullopt;
    std::string no_data_name = {};
  };

  /// \return the column's index
  int add(Column column);

  void set_text(int column, std::string_view text);      ///< cleaned to valid UTF-8; empty is absent
  void set_raw_text(int column, std::string_view text);  ///< the same for text known to be clean
  void set_enum(int column, std::uint8_t value);
  void set_int8(int column, std::int8_t value);
  void set_int64(int column, std::int64_t value);
  void set_float64(int column, double value);        ///< not finite is absent
  void set_unit_interval(int column, double value);  ///< clamped to [0, 1], stored in 1/255
  void end_row();

  std::uint32_t rows() const { return rows_; }

  /// Texts that repeat become enumerations where that is shorter, of the column's name: a byte for each row, each text
  /// once. Call it when all rows are there.
  void code_texts();

  /// The "properties" of the class.
  nlohmann::ordered_json class_properties() const;
  /// What code_texts() made, by name.
  nlohmann::json text_enums() const;
  /// The values of an enumeration that some row has, by value. \param enum_type  as in Column
  std::set<int> values_used(std::string_view enum_type) const;
  /// The table, its columns added to `document` as buffer views.
  nlohmann::ordered_json write(GlbDocument& document, const std::string& class_name) const;

 private:
  struct Data {
    Column column;
    std::string bytes;                   ///< values so far, little-endian
    std::vector<std::uint32_t> offsets;  ///< of texts
    bool any = false;                    ///< some row has a value
    bool set = false;                    ///< in the row being filled
    std::vector<std::string> names;      ///< of a coded text, by value; `bytes` are values then
  };
  void put(Data& data, const void* value, std::size_t size);
  /// The columns in the order of files.
  std::vector<const Data*> listed() const;

  Order order_;
  std::vector<Data> columns_;
  std::uint32_t rows_ = 0;
};

}  // namespace blockrand::outputs
