// JSON by hand: one string, no tree. Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

/// Appends JSON to a text; commas come by themselves.
class JsonText {
 public:
  JsonText() = default;
  explicit JsonText(std::string& text) : text_(&text) {}

  void comma() {
    const char last = text_->empty() ? '\n' : text_->back();
    if (last != '{' && last != '[' && last != ':' && last != '\n') *text_ += ',';
  }
  void key(std::string_view k) {
    comma();
    append_json(*text_, k);
    *text_ += ':';
  }
  void open(char bracket) {
    comma();
    *text_ += bracket;
  }
  void close(char bracket) { *text_ += bracket; }
  void string(std::string_view k, std::string_view value) {
    key(k);
    append_json(*text_, value);
  }
  void element(std::string_view value) {
    comma();
    append_json(*text_, value);
  }
  void element(double value) {
    comma();
    append_number(*text_, value);
  }
  void number(std::string_view k, double value) {
    key(k);
    append_number(*text_, value);
  }
  void flag(std::string_view k, bool value) {
    key(k);
    *text_ += value ? "true" : "false";
  }
  void integers(std::string_view k, std::size_t count, const std::function<std::int64_t(std::size_t)>& at) {
    key(k);
    open('[');
    for (std::size_t i = 0; i < count; ++i) {
      comma();
      append_number(*text_, at(i));
    }
    close(']');
  }

 private:
  std::string* text_ = nullptr;
};

}  // namespace blockrand::outputs
