// Shared libraries that are loaded when they are needed: what they bring costs more time than a small job that does without.
#pragma once

#include <string>

namespace blockrand::base {

/// A library that stays loaded to the end of the program.
class SharedLibrary {
 public:
  /// \param soname   the file that the program was compiled with: "libgdal.so.32"
  /// \param purpose  for the message: "GDAL, which reads rasters"
  /// \throws UsageError  it cannot be loaded
  SharedLibrary(const char* soname, const char* purpose);

  /// \throws UsageError  the library has no such function
  template <typename F>
  void find(F*& function, const char* name) const {
    function = reinterpret_cast<F*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;
  [[noreturn]] void fail() const;
  const char* soname_;
  const char* purpose_;
  void* handle_;
};

}  // namespace blockrand::base
