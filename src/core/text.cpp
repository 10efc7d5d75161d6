#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace sphgeo {

namespace {

/// Lower case, with `-` and `_` dropped: what people mix up.
std::string folded(std::string_view text) {
  std::string out;
  for (const char c : lower_case(text)) {
    if (c != '-' && c != '_') out += c;
  }
  return out;
}

/// Of a whole UTF-8 character: whether it acts on the terminal in place of being shown. That are
/// C0, DEL, C1 (U+0080 to U+009F), the separators of lines and paragraphs (U+2028, U+2029) and the
/// embeddings, overrides and isolates of bidirectional text (U+202A to U+202E, U+2066 to U+2069).
bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(character[k]); };
  if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7f;
  if (character.size() == 2) return byte(0) == 0xc2 && byte(1) < 0xa0;
  if (character.size() != 3 || byte(0) != 0xe2) return false;
  return (byte(1) == 0x80 && byte(2) >= 0xa8 && byte(2) <= 0xae) ||
         (byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9);
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t n = a.size();
  const std::size_t m = b.size();
  std::vector<int> before(m + 1), last(m + 1), now(m + 1);
  for (std::size_t j = 0; j <= m; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= m; ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        now[j] = std::min(now[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[m];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 200;  // nobody misspells longer names, and the table is quadratic
  if (name.empty() || name.size() > longest) return {};
  const std::string wanted = folded(name);
  for (const std::string& c : candidates) {
    if (!wanted.empty() && folded(c) == wanted) return c;
  }
  const int reach = name.size() < 4 ? 1 : 2;
  int best = reach + 1;
  std::size_t alike = 0;  // characters at the beginning; of names equally near, the one that starts
                          // more like it is meant
  std::string found;
  for (const std::string& c : candidates) {
    const std::size_t longer = std::max(name.size(), c.size()),
                      shorter = std::min(name.size(), c.size());
    if (longer - shorter > static_cast<std::size_t>(reach)) continue;  // that many edits at least
    // A name may not be replaced as a whole: "t" is no misspelling of "x".
    const int d = edit_distance(name, c);
    if (d > best || d > reach || d >= static_cast<int>(longer)) continue;
    const auto same = static_cast<std::size_t>(
        std::mismatch(name.begin(), name.end(), c.begin(), c.end()).first - name.begin());
    if (d < best || same > alike) {
      best = d;
      alike = same;
      found = c;
    }
  }
  if (!found.empty() || name.size() < 3) return found;
  for (const std::string& c : candidates) {
    if (c.rfind(name, 0) != 0) continue;
    if (!found.empty()) return {};
    found = c;
  }
  return found;
}

namespace {

// The candidates that begin with the name, or, where none does, those that share a word of it
// between underscores: "skin_state" and "interface_state".
std::vector<std::string> related_names(std::string_view name,
                                       const std::vector<std::string>& candidates) {
  constexpr std::size_t shortest = 4;  // of a word that tells something
  const auto collect = [&](auto&& fits) {
    std::vector<std::string> found;
    for (const std::string& c : candidates)
      if (fits(c) && std::find(found.begin(), found.end(), c) == found.end()) found.push_back(c);
    return found;
  };
  if (name.size() >= shortest)
    if (auto found = collect([&](const std::string& c) { return c.starts_with(name); });
        !found.empty())
      return found;
  const auto words = [](std::string_view text) {
    std::vector<std::string_view> out;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find_first_of("_-", at), text.size());
      if (end - at >= shortest) out.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return out;
  };
  const auto wanted = words(name);
  return collect([&](const std::string& c) {
    const auto own = words(c);
    return std::find_first_of(own.begin(), own.end(), wanted.begin(), wanted.end()) != own.end();
  });
}

}  // namespace

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view what) {
  if (const std::string near = nearest_name(name, candidates); !near.empty()) {
    return fmt::format("did you mean '{}'?", near);
  }
  constexpr std::size_t most_related = 10;
  if (std::vector<std::string> related = related_names(name, candidates);
      !related.empty() && related.size() <= most_related) {
    for (std::string& r : related) r = "'" + r + "'";
    return fmt::format("did you mean {}?", in_words(related, "or"));
  }
  constexpr std::size_t few = 16;
  if (candidates.empty() || candidates.size() > few) return {};
  return fmt::format("{}: {}", what, in_words(candidates));
}

std::string in_words(const std::vector<std::string>& names, std::string_view last) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? fmt::format(" {} ", last) : std::string(", ");
    out += names[i];
  }
  return out;
}

std::string exact(double value) { return fmt::format("{}", value); }

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return std::string(text);
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80) --bytes;
  return std::string(text.substr(0, bytes)) + "...";
}

std::size_t invalid_utf8(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  for (std::size_t k = 0; k < text.size();) {
    const unsigned char lead = byte(k);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xc2 ? 0
                               : lead < 0xe0 ? 2
                               : lead < 0xf0 ? 3
                               : lead < 0xf5 ? 4
                                             : 0;
    if (length == 0 || k + length > text.size()) return k;
    for (std::size_t j = 1; j < length; ++j)
      if ((byte(k + j) & 0xc0) != 0x80) return k;
    // Longer than needed, a surrogate, or beyond U+10FFFF.
    const unsigned char next = length > 2 ? byte(k + 1) : 0;
    if ((lead == 0xe0 && next < 0xa0) || (lead == 0xed && next > 0x9f) ||
        (lead == 0xf0 && next < 0x90) || (lead == 0xf4 && next > 0x8f))
      return k;
    k += length;
  }
  return std::string_view::npos;
}

std::string printable(std::string_view text, std::string_view keep) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    // Up to the next byte that is no UTF-8, characters are whole.
    const std::size_t valid = std::min(invalid_utf8(text), text.size());
    for (std::size_t k = 0; k < valid;) {
      const auto lead = static_cast<unsigned char>(text[k]);
      const std::size_t length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
      const std::string_view character = text.substr(k, length);
      k += length;
      const bool kept = length == 1 && keep.find(character[0]) != std::string_view::npos;
      if (character == "\t" && !kept) out += ' ';
      else if (!kept && is_control(character)) out += '?';
      else out += character;
    }
    text.remove_prefix(valid);
    if (text.empty()) break;
    out += '?';
    text.remove_prefix(1);
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace sphgeo
