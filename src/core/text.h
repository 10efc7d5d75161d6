#pragma once
// Small text helpers: the nearest valid name to a misspelt one, lists in words, exact numbers.

#include <string>
#include <string_view>
#include <vector>

namespace sphgeo {

/// Edits (insert, delete, replace, swap of neighbors) that turn a into b; case counts.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate a misspelt name most likely means, or "": up to 2 edits away (1 for names shorter
/// than 4), else equal but for case, `-` and `_`, else the only one that begins with the name.
/// Among equals the earlier candidate wins.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// "did you mean 'porosity'?"; when none is near, a few that begin with the name or share a word of
/// it between underscores, or the list of valid names when they are few.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view what = "valid names");

/// "a, b and c".
std::string in_words(const std::vector<std::string>& names, std::string_view last = "and");

/// The shortest text that reads back as exactly this number.
std::string exact(double value);

std::string lower_case(std::string_view text);

/// The text, or its first `bytes` bytes and "..."; a UTF-8 character is kept or dropped as a whole.
std::string shortened(std::string_view text, std::size_t bytes);

/// Where the first byte stands that is no part of valid UTF-8 (RFC 3629); npos when all is valid.
std::size_t invalid_utf8(std::string_view text);

/// What may be sent to a terminal as part of a line: each control character (the end of a line too,
/// unless it is among `keep`), each character that turns the direction of writing and each byte
/// that is no UTF-8 becomes '?', a tab a blank.
std::string printable(std::string_view text, std::string_view keep = {});

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace sphgeo
