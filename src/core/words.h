#pragma once
// The words of a text file one after the other, with the line for messages.

#include <string>
#include <string_view>

#include "core/error.h"

namespace sphgeo {

/// Splits a text into words between blanks. Lines end in LF, CR LF or CR.
class Words {
 public:
  /// `text` must outlive this; `path` is for the messages.
  Words(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

  /// The next word, "" at the end.
  std::string_view next();
  /// The next word without taking it.
  std::string_view peek() const { return Words(*this).next(); }
  /// Leaves out the rest of the line.
  void skip_line();
  /// The next word as a finite or infinite number. Throws IoError with the line for other text.
  double number();
  /// The line of the last word, from 1.
  int line() const { return line_; }
  /// Throws IoError with file and line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool at_line_end() const;

  std::string_view text_;
  std::string path_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace sphgeo
