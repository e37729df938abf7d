// A SQLite file opened for reading only, with rows as plain values.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

namespace blockrand::validate {

/// The columns of the row at hand; views hold until the next row.
class SqliteRow {
 public:
  explicit SqliteRow(sqlite3_stmt* statement) : statement_(statement) {}
  bool null(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_NULL; }
  bool is_real(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_FLOAT; }
  bool is_integer(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_INTEGER; }
  bool is_text(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_TEXT; }
  std::int64_t integer(int i) const { return sqlite3_column_int64(statement_, i); }
  double real(int i) const { return sqlite3_column_double(statement_, i); }
  /// Text as UTF-8, or the bytes of a blob.
  std::string_view text(int i) const {
    const void* const bytes =
        is_text(i) ? static_cast<const void*>(sqlite3_column_text(statement_, i)) : sqlite3_column_blob(statement_, i);
    return bytes == nullptr ? std::string_view()
                            : std::string_view(static_cast<const char*>(bytes),
                                               static_cast<std::size_t>(sqlite3_column_bytes(statement_, i)));
  }
  std::string string(int i) const { return std::string(text(i)); }

 private:
  sqlite3_stmt* statement_;
};

class SqliteFile {
 public:
  explicit SqliteFile(const std::string& path);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  /// False when the file could not be opened; error() says why.
  bool open() const { return db_ != nullptr; }
  const std::string& error() const { return error_; }

  /// Calls `row` for each row of the result. \returns false and sets error() when SQLite cannot finish.
  /// \param arguments  texts for the statement's `?`, in order
  bool each(const std::string& sql, const std::function<void(const SqliteRow&)>& row,
            std::initializer_list<std::string_view> arguments = {});
  /// The first value of the first row, or `otherwise`.
  std::int64_t integer(const std::string& sql, std::int64_t otherwise = 0);
  std::string text(const std::string& sql);

 private:
  sqlite3* db_ = nullptr;
  std::string error_;
};

}  // namespace blockrand::validate
