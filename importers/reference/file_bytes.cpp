#include "importers/reference/file_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

[[noreturn]] void refuse_length(const std::string& path) {
  throw base::InputError(path, "", "is longer than 4 GB when unpacked",
                         "Split it, or give a CityJSON text sequence, which is read line by line");
}

}  // namespace

void check_readable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(path, error)) throw base::InputError(path, "", "there is no such file", "");
  if (fs::is_directory(path, error)) throw base::InputError(path, "", "is a directory", "Name the model files in it");
  if (fs::file_size(path, error) == 0 && !error) throw base::InputError(path, "", "is empty", "");
}

std::uint64_t size_on_disk(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

struct ByteReader::File {
  gzFile handle;
};

ByteReader::ByteReader(const std::string& path)
    : path_(path), file_(std::make_unique<File>(File{gzopen(path.c_str(), "rb")})) {
  constexpr unsigned kBuffer = 1U << 18;
  if (file_->handle == nullptr) throw base::InputError(path, "", "cannot be opened", "");
  gzbuffer(file_->handle, kBuffer);
}

ByteReader::~ByteReader() { gzclose(file_->handle); }

std::size_t ByteReader::read(char* buffer, std::size_t length) {
  constexpr std::size_t kMost = 1U << 30;  // zlib counts in int
  const int got = gzread(file_->handle, buffer, static_cast<unsigned>(std::min(length, kMost)));
  int error = Z_OK;
  gzerror(file_->handle, &error);
  if (got < 0 || error == Z_BUF_ERROR || error == Z_DATA_ERROR) damaged_ = true;
  return static_cast<std::size_t>(std::max(0, got));
}

std::optional<std::string> ByteReader::line() {
  constexpr std::size_t kPiece = 1U << 16;
  for (std::size_t searched = used_;;) {
    if (const std::size_t end = buffer_.find('\n', searched); end != std::string::npos) {
      std::string out = buffer_.substr(used_, end - used_);
      used_ = end + 1;
      return out;
    }
    buffer_.erase(0, used_);
    used_ = 0;
    searched = buffer_.size();
    if (searched > kLongestText) refuse_length(path_);
    buffer_.resize(searched + kPiece);
    buffer_.resize(searched + read(buffer_.data() + searched, kPiece));
    if (buffer_.size() > searched) continue;
    if (buffer_.empty()) return std::nullopt;
    return std::exchange(buffer_, {});
  }
}

std::string first_bytes(const std::string& path, std::size_t length) {
  ByteReader reader(path);
  std::string out(length, '\0');
  std::size_t size = 0;
  while (size < length) {
    const std::size_t got = reader.read(out.data() + size, length - size);
    if (got == 0) break;
    size += got;
  }
  out.resize(size);
  return out;
}

std::string all_bytes(const std::string& path) {
  ByteReader reader(path);
  constexpr std::size_t kPiece = 1U << 20;
  std::string out;
  for (std::size_t size = 0;;) {
    if (size > kLongestText) refuse_length(path);
    out.resize(size + kPiece);
    const std::size_t got = reader.read(out.data() + size, kPiece);
    size += got;
    out.resize(size);
    if (got == 0) break;
  }
  if (reader.damaged()) throw base::InputError(path, "", "the gzip archive is cut off or damaged", "");
  return out;
}

}  // namespace blockrand::importers::reference
