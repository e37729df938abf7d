#include "importers/osm/bzip2_stream.h"

#include <bzlib.h>

#include <osmium/io/compression.hpp>
#include <osmium/io/detail/read_write.hpp>
#include <osmium/io/error.hpp>
#include <osmium/io/file_compression.hpp>
#include <string>

namespace blockrand::importers::osm {
namespace {

class Bzip2Stream final : public osmium::io::Decompressor {
 public:
  explicit Bzip2Stream(int fd) : fd_(fd), input_(64 * 1024, '\0') {}
  ~Bzip2Stream() noexcept override {
    try {
      close();
    } catch (...) {  // a destructor does not throw
    }
  }
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;
  Bzip2Stream(Bzip2Stream&&) = delete;
  Bzip2Stream& operator=(Bzip2Stream&&) = delete;

  /// The next piece of text; empty at the end.
  std::string read() override {
    std::string output(input_buffer_size, '\0');
    stream_.next_out = output.data();
    stream_.avail_out = static_cast<unsigned>(output.size());
    while (stream_.avail_out > 0) {
      if (stream_.avail_in == 0 && !fill()) {
        if (in_stream_) throw osmium::io_error{"the compressed data ends too early"};
        break;
      }
      if (!in_stream_) begin_stream();
      const int result = BZ2_bzDecompress(&stream_);
      if (result == BZ_STREAM_END) {
        BZ2_bzDecompressEnd(&stream_);
        in_stream_ = false;
        ++streams_;
      } else if (result != BZ_OK) {
        throw osmium::io_error{result == BZ_DATA_ERROR_MAGIC && streams_ > 0
                                   ? "something else follows the compressed data"
                                   : "the compressed data is damaged"};
      }
    }
    output.resize(output.size() - stream_.avail_out);
    return output;
  }

  void close() override {
    if (in_stream_) BZ2_bzDecompressEnd(&stream_);
    in_stream_ = false;
    if (fd_ < 0) return;
    const int fd = fd_;
    fd_ = -1;
    osmium::io::detail::reliable_close(fd);
  }

 private:
  bool fill() {
    const auto n = osmium::io::detail::reliable_read(fd_, input_.data(), static_cast<unsigned>(input_.size()));
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<unsigned>(n);
    read_ += static_cast<std::size_t>(n);
    set_offset(read_);
    return n > 0;
  }

  void begin_stream() {
    // Initialisation must not forget where input and output stand.
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw osmium::io_error{"bzip2 cannot be initialised"};
    in_stream_ = true;
  }

  int fd_;
  std::string input_;
  bz_stream stream_{};
  bool in_stream_ = false;
  int streams_ = 0;
  std::size_t read_ = 0;
};

}  // namespace

void use_own_bzip2() {
  static const bool registered = osmium::io::CompressionFactory::instance().register_compression(
      osmium::io::file_compression::bzip2,
      [](int, osmium::io::fsync) -> osmium::io::Compressor* {
        throw osmium::unsupported_file_format_error{"bzip2 is only read here"};
      },
      [](int fd) -> osmium::io::Decompressor* { return new Bzip2Stream{fd}; },
      [](const char*, std::size_t) -> osmium::io::Decompressor* {
        throw osmium::unsupported_file_format_error{"bzip2 is only read from files here"};
      });
  (void)registered;
}

}  // namespace blockrand::importers::osm
