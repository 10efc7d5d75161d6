#include "core/words.h"

#include <optional>

#include "core/decimal.h"
#include "core/text.h"

namespace sphgeo {
namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

// A CR counts unless an LF follows it.
bool Words::at_line_end() const {
  return text_[at_] == '\n' ||
         (text_[at_] == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '\n'));
}

std::string_view Words::next() {
  for (; at_ < text_.size() && is_space(text_[at_]); ++at_) line_ += at_line_end();
  const std::size_t first = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return text_.substr(first, at_ - first);
}

void Words::skip_line() {
  while (at_ < text_.size() && !at_line_end()) ++at_;
}

double Words::number() {
  const std::string_view word = next();
  if (word.empty()) fail("expected a number, and the file ends here");
  const std::optional<double> value = read_decimal(word);
  if (!value) {
    const std::string why = why_no_decimal(word);
    fail(why.ends_with(" is not a number")
             ? "expected a number, found '" + shortened(word, 60) + "'"
             : why);
  }
  return *value;
}

void Words::fail(const std::string& what) const {
  throw IoError(path_, "line " + std::to_string(line_) + ": " + what);
}

}  // namespace sphgeo
