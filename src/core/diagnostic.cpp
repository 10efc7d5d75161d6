#include "core/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/text.h"

namespace sphgeo {

namespace {

constexpr int most_errors = 20;

std::string_view line_of(std::string_view text, int line) {
  for (int k = 1; k < line; ++k) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

/// The length of the word at `column` (from 0), for underlining.
std::size_t word_length(std::string_view line, std::size_t column) {
  if (column >= line.size()) return 1;
  const char quote = line[column];
  if (quote == '"' || quote == '\'') {
    const std::size_t end = line.find(quote, column + 1);
    return end == std::string_view::npos ? 1 : end - column + 1;
  }
  const std::size_t end = line.find_first_of(" \t:,]}[{=#", column);
  return std::max<std::size_t>(1, (end == std::string_view::npos ? line.size() : end) - column);
}

const char* severity_name(Severity s) {
  return s == Severity::error ? "error" : s == Severity::warning ? "warning" : "note";
}

/// Characters of UTF-8, each taken to be as wide as a letter.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

struct Colors {
  std::string_view bold, strong, off;
};

std::string heading(const Diagnostic& d, const Colors& c) {
  std::string at = d.place.file;
  // An override is a single line: its number is its place.
  if (d.place.line > 0 && at.rfind("--set", 0) != 0) {
    at += fmt::format(":{}:{}", d.place.line, std::max(1, d.place.column));
  }
  if (!at.empty()) at += ": ";
  constexpr std::size_t longest_message = 600;
  std::string message = shortened(d.message, longest_message);
  if (!d.path.empty() && message.find(d.path) == std::string::npos)
    message = d.path + ": " + message;
  return fmt::format("{}{}{}{}[{}]{}: {}\n", c.bold, printable(at), c.strong,
                     severity_name(d.severity), d.id, c.off, printable(message));
}

}  // namespace

void Diagnostics::error(std::string id, Place at, std::string path, std::string message,
                        std::string help) {
  add({Severity::error, std::move(id), std::move(at), std::move(path), std::move(message),
       std::move(help)});
}

void Diagnostics::warning(std::string id, Place at, std::string path, std::string message,
                          std::string help) {
  add({Severity::warning, std::move(id), std::move(at), std::move(path), std::move(message),
       std::move(help)});
}

bool Diagnostics::has_errors() const {
  return std::any_of(items_.begin(), items_.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::error; });
}

void Diagnostics::keep_source(std::string name, std::string text) {
  sources_.push_back({std::move(name), std::move(text)});
}

void Diagnostics::append(const Diagnostics& other) {
  items_.insert(items_.end(), other.items_.begin(), other.items_.end());
  sources_.insert(sources_.end(), other.sources_.begin(), other.sources_.end());
}

std::string Diagnostics::render(bool color) const {
  const Colors c = color ? Colors{"\x1b[1m", "\x1b[1;31m", "\x1b[0m"} : Colors{};
  const auto source_index = [this](const std::string& name) {
    return std::find_if(sources_.begin(), sources_.end(),
                        [&](const Source& s) { return s.name == name; }) -
           sources_.begin();
  };
  std::vector<const Diagnostic*> order;
  for (const Diagnostic& d : items_) order.push_back(&d);
  std::stable_sort(order.begin(), order.end(), [&](const Diagnostic* a, const Diagnostic* b) {
    return std::tuple(source_index(a->place.file), a->place.line, a->place.column) <
           std::tuple(source_index(b->place.file), b->place.line, b->place.column);
  });

  std::string out;
  int errors = 0;
  for (const Diagnostic* d : order) {
    if (d->severity == Severity::error && ++errors > most_errors) continue;
    out += heading(*d, c);
    const auto source = static_cast<std::size_t>(source_index(d->place.file));
    std::string_view line;
    if (source < sources_.size() && d->place.line > 0) {
      line = line_of(sources_[source].text, d->place.line);
    }
    constexpr std::size_t widest = 200;
    const std::string help = printable(d->help);
    if (line.empty() || line.size() > widest) {
      if (!help.empty()) out += fmt::format("      = help: {}\n", help);
      continue;
    }
    const std::size_t column =
        std::min(static_cast<std::size_t>(std::max(1, d->place.column) - 1), line.size());
    const std::size_t length = word_length(line, column);
    // Widths are those of what is shown: a blank or '?' for each character that is not.
    const std::size_t before = width_of(printable(line.substr(0, column)));
    const std::size_t width =
        std::max<std::size_t>(1, width_of(printable(line.substr(column, length))));
    const std::string marks = "^" + std::string(width - 1, '~');
    out += fmt::format("{:>5} | {}\n", d->place.line, printable(line));
    out += fmt::format("{:>5} | {}{}{}{}{}{}\n", "", std::string(before, ' '), c.strong, marks,
                       c.off, help.empty() ? "" : " ", help);
  }
  if (errors > most_errors) out += fmt::format("... and {} more errors\n", errors - most_errors);
  return out;
}

}  // namespace sphgeo
