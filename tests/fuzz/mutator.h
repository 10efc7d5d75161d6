#pragma once
// Makes inputs from stored ones: a fixed seed gives a fixed sequence.

#include <cstdint>
#include <string>
#include <vector>

namespace sphgeo::fuzz {

/// Changes inputs at random: bits, bytes, ranges, numbers, words of the target's language, parts of
/// other inputs.
class Mutator {
 public:
  /// `words` are texts that mean something to the reader.
  Mutator(std::uint64_t seed, std::vector<std::string> words, std::size_t longest);

  /// The next input: one to eight changes of `from`; `other` may lend a part.
  std::string next(std::string from, const std::string& other);
  /// A random number in [0, n); 0 for n = 0.
  std::size_t below(std::size_t n);

 private:
  void change(std::string& input, const std::string& other);

  std::uint64_t seed_;
  std::uint64_t count_ = 0;
  std::vector<std::string> words_;
  std::size_t longest_;
};

/// The words of a dictionary in libFuzzer's format: `name="word"`, # comments, \xAB escapes.
std::vector<std::string> read_words(const std::string& path);

}  // namespace sphgeo::fuzz
