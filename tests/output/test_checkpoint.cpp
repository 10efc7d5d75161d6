#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "output/checkpoint.h"
#include "output/temporary_folder.h"

using namespace sphgeo;
using test::TemporaryFolder;

namespace {

std::uint64_t write_sample(const std::string& path, const std::string& previous, double first) {
  const std::vector<double> places = {first, 2.5, -0.0, 1e-310, 5, 6};
  const std::vector<std::int32_t> tags = {-1, 7};
  const std::vector<std::uint64_t> ids = {0, ~std::uint64_t{0}};
  CheckpointWriter file(1000);
  file.put("sets/water/position", places, 3);
  file.put("sets/water/part", tags);
  file.put("sets/water/id", ids);
  file.put("sets/soil/position", std::vector<double>{});
  file.put_text("deck", "title: Größe\n");
  file.put_number("time", 0.1);
  file.put_count("steps", 1'000'000'000'000);
  return file.write(path, previous);
}

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("a checkpoint gives back every bit") {
    const TemporaryFolder folder;
    const std::string path = folder / "checkpoint.h5";
    const std::uint64_t bytes = write_sample(path, folder / "previous.h5", 1.5);
    CHECK(read_file(path).size() == bytes);
    CHECK(folder.entries() == 1);  // nothing half-written, and no previous one yet
    const CheckpointReader file(path);
    std::vector<double> places(6);
    file.get("sets/water/position", std::span<double>(places));
    CHECK(places == std::vector<double>{1.5, 2.5, -0.0, 1e-310, 5, 6});
    CHECK(std::signbit(places[2]));
    std::vector<std::int32_t> tags(2);
    file.get("sets/water/part", std::span<std::int32_t>(tags));
    CHECK(tags == std::vector<std::int32_t>{-1, 7});
    std::vector<std::uint64_t> ids(2);
    file.get("sets/water/id", std::span<std::uint64_t>(ids));
    CHECK(ids[1] == ~std::uint64_t{0});
    CHECK(file.size("sets/soil/position") == 0);
    CHECK(file.text("deck") == "title: Größe\n");
    CHECK(file.number("time") == 0.1);
    CHECK(file.count("steps") == 1'000'000'000'000);
    CHECK(file.has("sets/water/id"));
    CHECK_FALSE(file.has("sets/water/velocity"));
    CHECK_FALSE(file.has("sets/rock/velocity"));
    // The same state gives the same file.
    write_sample(folder / "again.h5", "", 1.5);
    CHECK(read_file(folder / "again.h5") == read_file(path));
  }

  TEST_CASE(
      "a large checkpoint is the same file with any number of threads, however large it was "
      "thought to be") {
    const TemporaryFolder folder;
    std::vector<double> places(3 * 300'001);
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = random_uniform(7, k);
    const std::vector<std::int32_t> tags(300'001, 3);
    const auto write = [&](const std::string& path, std::size_t expected) {
      CheckpointWriter file(expected);
      for (const char* name : {"a", "b", "c"}) file.put(name, places, 3);
      file.put("tags", tags);
      return file.write(path, "");
    };
    const std::size_t right = 3 * 8 * places.size() + 4 * tags.size();
    const int before = threads();
    set_threads(1);
    const std::uint64_t bytes = write(folder / "one", right);
    CHECK(bytes < right + right / 10 + 500'000);
    for (const int n : {2, 3}) {
      set_threads(n);
      CHECK(write(folder / "more", right) == bytes);
      CHECK(read_file(folder / "more") == read_file(folder / "one"));
    }
    for (const std::size_t expected : {std::size_t{0}, right / 2, 3 * right}) {
      write(folder / "guessed", expected);
      const CheckpointReader file(folder / "guessed");
      for (const char* name : {"a", "b", "c"}) {
        std::vector<double> back(places.size());
        file.get(name, std::span<double>(back));
        CHECK(back == places);
      }
      std::vector<std::int32_t> tags_back(tags.size());
      file.get("tags", std::span<std::int32_t>(tags_back));
      CHECK(tags_back == tags);
    }
    set_threads(before);
  }

  TEST_CASE("what does not fit a checkpoint is an error with its name") {
    const TemporaryFolder folder;
    write_sample(folder / "c.h5", "", 1);
    const CheckpointReader file(folder / "c.h5");
    std::vector<double> four(4);
    CHECK_THROWS_WITH_AS(file.get("sets/water/position", std::span<double>(four)),
                         doctest::Contains("6 numbers where this run has 4"), IoError);
    CHECK_THROWS_WITH_AS(file.get("sets/water/part", std::span<double>(four)),
                         doctest::Contains("another kind"), IoError);
    CHECK_THROWS_WITH_AS(file.number("temperature"), doctest::Contains("'temperature'"), IoError);
  }

  TEST_CASE("the one before is kept, and used when the newest is damaged") {
    const TemporaryFolder folder;
    const std::string path = folder / "checkpoint.h5", previous = folder / "checkpoint.prev.h5";
    CHECK(find_checkpoint(path, previous).reader == nullptr);
    write_sample(path, previous, 1);
    write_sample(path, previous, 2);
    const auto first_of = [](const FoundCheckpoint& found) {
      std::vector<double> places(6);
      found.reader->get("sets/water/position", std::span<double>(places));
      return places[0];
    };
    CHECK(first_of(find_checkpoint(path, previous)) == 2);
    const std::string whole = read_file(path);
    std::ofstream(path, std::ios::binary) << whole.substr(0, whole.size() / 2);
    FoundCheckpoint found = find_checkpoint(path, previous);
    CHECK(found.path == previous);
    CHECK(first_of(found) == 1);
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].find("damaged") != std::string::npos);
    std::ofstream(previous, std::ios::binary) << "nothing";
    CHECK_THROWS_WITH_AS(find_checkpoint(path, previous), doctest::Contains("no intact checkpoint"),
                         IoError);
  }

  TEST_CASE("every flipped bit and every cut is found") {
    const TemporaryFolder folder;
    write_sample(folder / "c.h5", "", 1);
    const std::string whole = read_file(folder / "c.h5");
    CHECK_NOTHROW(CheckpointReader(whole, "c.h5"));
    std::size_t missed = 0;
    for (std::uint64_t k = 0; k < 3000; ++k) {
      std::string bad = whole;
      bad[random_bits(1, k) % bad.size()] ^= static_cast<char>(1 << (random_bits(2, k) % 8));
      try {
        const CheckpointReader reader(bad, "bad");
        ++missed;
      } catch (const IoError&) {
      }
    }
    // The padding behind the checksum means nothing, but is compared like the rest.
    CHECK(missed == 0);
    // Two flipped signs, of numbers near to each other.
    for (std::size_t at = 1031; at + 96 < whole.size(); at += at < 16384 ? 8 : 776)
      for (const std::size_t apart : {8, 32, 64}) {
        std::string bad = whole;
        bad[at] ^= static_cast<char>(0x80);
        bad[at + apart] ^= static_cast<char>(0x80);
        CHECK_THROWS_AS(CheckpointReader(bad, "bad"), IoError);
      }
    for (std::uint64_t k = 0; k < 200; ++k)
      CHECK_THROWS_AS(CheckpointReader(whole.substr(0, random_bits(3, k) % whole.size()), "cut"),
                      IoError);
    CHECK_THROWS_AS(CheckpointReader("", "empty"), IoError);
  }

  TEST_CASE("a checkpoint that cannot be written leaves the earlier one") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(write_sample(folder / "no/such/c.h5", folder / "no/such/p.h5", 1), IoError);
    CHECK(folder.entries() == 0);
  }
}
