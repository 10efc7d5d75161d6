#include "mutator.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "core/hash.h"

namespace sphgeo::fuzz {

namespace {

/// Numbers at which readers break.
constexpr const char* numbers[] = {"0",
                                   "-1",
                                   "1e308",
                                   "1e-320",
                                   "1e400",
                                   "nan",
                                   "-inf",
                                   "2",
                                   "3",
                                   "0x1F",
                                   "010",
                                   "1_000",
                                   "0.5",
                                   "1e15",
                                   "-1e300",
                                   "2147483648",
                                   "-9223372036854775809",
                                   "18446744073709551616"};
constexpr unsigned char bytes[] = {0x00, 0x01, 0x09, 0x0a, 0x0d, 0x20, 0x7f, 0x80,
                                   0xff, 0xfe, 0xef, 0xc3, '"',  '[',  '{',  ':'};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

Mutator::Mutator(std::uint64_t seed, std::vector<std::string> words, std::size_t longest)
    : seed_(seed), words_(std::move(words)), longest_(longest) {}

std::size_t Mutator::below(std::size_t n) { return n == 0 ? 0 : random_bits(seed_, count_++) % n; }

std::string Mutator::next(std::string from, const std::string& other) {
  const std::size_t changes = 1 + below(below(2) == 0 ? 2 : 8);
  for (std::size_t k = 0; k < changes; ++k) change(from, other);
  if (from.size() > longest_) from.resize(longest_);
  return from;
}

void Mutator::change(std::string& in, const std::string& other) {
  const std::size_t at = below(in.size() + 1);
  const std::size_t length = 1 + below(below(4) == 0 ? in.size() : 16);
  switch (below(10)) {
    case 0:
      if (at < in.size()) in[at] = static_cast<char>(in[at] ^ (1 << below(8)));
      break;
    case 1:
      if (at < in.size()) in[at] = static_cast<char>(bytes[below(std::size(bytes))]);
      break;
    case 2:
      in.insert(at, 1, static_cast<char>(below(256)));
      break;
    case 3:
      in.erase(at, length);
      break;
    case 4:
      in.insert(at, in.substr(below(in.size() + 1), length));
      break;
    case 5:
      if (!words_.empty()) in.insert(at, words_[below(words_.size())]);
      break;
    case 6:
      in.insert(at, other.substr(below(other.size() + 1), 4 * length));
      break;
    case 7: {  // another number where one stands
      const auto first =
          std::find_if(in.begin() + static_cast<std::ptrdiff_t>(at), in.end(), is_digit);
      const auto last =
          std::find_if_not(first, in.end(), [](char c) { return is_digit(c) || c == '.'; });
      in.replace(first, last, numbers[below(std::size(numbers))]);
      break;
    }
    case 8: {  // the same again and again
      const std::string part = in.substr(at, length);
      for (std::size_t k = below(200); k > 0 && in.size() < longest_; --k) in.insert(at, part);
      break;
    }
    default:
      if (below(4) == 0) in.resize(at);
  }
}

std::vector<std::string> read_words(const std::string& path) {
  std::vector<std::string> words;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t from = line.find('"'), to = line.rfind('"');
    if (line.starts_with('#') || from >= to || to == std::string::npos) continue;
    std::string word;
    for (std::size_t k = from + 1; k < to; ++k) {
      if (line[k] == '\\' && line[k + 1] == 'x' && k + 3 < to) {
        word += static_cast<char>(std::stoi(line.substr(k + 2, 2), nullptr, 16));
        k += 3;
      } else {
        k += line[k] == '\\';
        word += line[k];
      }
    }
    words.push_back(word);
  }
  return words;
}

}  // namespace sphgeo::fuzz
