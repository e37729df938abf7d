// SHA-256 of files and bytes (OpenSSL).
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace blockrand::base {

/// A digest that grows piece by piece.
class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();
  void add(std::string_view bytes);
  /// Lower-case hex digest of everything added. Call once.
  std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Lower-case hex digest of bytes.
std::string sha256_of(std::string_view bytes);

/// Lower-case hex digest of a file's content. \throws InputError when it cannot be read.
std::string sha256_file(const std::string& path);

}  // namespace blockrand::base
