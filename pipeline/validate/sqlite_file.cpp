#include "pipeline/validate/sqlite_file.h"

#include <filesystem>
#include <memory>

namespace blockrand::validate {
namespace {

/// A path as SQLite's URI: immutable, so that neither locks nor journals are made or looked for.
std::string uri_of(const std::string& path) {
  constexpr std::string_view hex = "0123456789ABCDEF";
  std::error_code ignored;
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(path, ignored).string()) {
    const auto b = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#') {
      uri += '%';
      uri += hex[b >> 4];
      uri += hex[b & 15];
    } else {
      uri += c;
    }
  }
  return uri + "?mode=ro&immutable=1";
}

}  // namespace

SqliteFile::SqliteFile(const std::string& path) {
  const int code = sqlite3_open_v2(uri_of(path).c_str(), &db_,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) {
    error_ = db_ != nullptr ? sqlite3_errmsg(db_) : "no memory";
    sqlite3_close(db_);
    db_ = nullptr;
    return;
  }
  // The file may come from anyone: its schema runs no functions, and pages are looked at before they are trusted.
  sqlite3_db_config(db_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  each("PRAGMA cell_size_check = ON", [](const SqliteRow&) {});
  error_.clear();
}

SqliteFile::~SqliteFile() { sqlite3_close(db_); }

bool SqliteFile::each(const std::string& sql, const std::function<void(const SqliteRow&)>& row,
                      std::initializer_list<std::string_view> arguments) {
  if (db_ == nullptr) return false;
  sqlite3_stmt* made = nullptr;
  if (sqlite3_prepare_v2(db_, sql.c_str(), static_cast<int>(sql.size()), &made, nullptr) != SQLITE_OK) {
    error_ = sqlite3_errmsg(db_);
    return false;
  }
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(made, &sqlite3_finalize);
  int position = 0;
  for (const std::string_view text : arguments)
    sqlite3_bind_text(statement.get(), ++position, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(statement.get())) == SQLITE_ROW) row(SqliteRow(statement.get()));
  if (code != SQLITE_DONE) error_ = sqlite3_errmsg(db_);
  return code == SQLITE_DONE;
}

std::int64_t SqliteFile::integer(const std::string& sql, std::int64_t otherwise) {
  bool first = true;
  each(sql, [&](const SqliteRow& row) {
    if (first && !row.null(0)) otherwise = row.integer(0);
    first = false;
  });
  return otherwise;
}

std::string SqliteFile::text(const std::string& sql) {
  std::string out;
  bool first = true;
  each(sql, [&](const SqliteRow& row) {
    if (first) out = row.string(0);
    first = false;
  });
  return out;
}

}  // namespace blockrand::validate
