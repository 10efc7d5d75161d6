// Checkpoints: any damage is detected, and foreign files are refused.

#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "output/checkpoint.h"
#include "targets.h"

namespace sphgeo::fuzz {

namespace {

/// A small checkpoint of all kinds of values, as the program writes it.
std::string sound_checkpoint() {
  const std::string path = scratch_folder() + "/checkpoint.h5";
  CheckpointWriter writer;
  writer.put_text("version", "0.1.0");
  writer.put("sets/water/position", std::vector<double>{0, 1, 2, 3, 4, 5}, 2);
  writer.put("sets/water/part", std::vector<std::int32_t>{0, 1, 2});
  writer.put("sets/water/id", std::vector<std::uint64_t>{7, 8, 9});
  writer.put_count("clock/steps", 12);
  writer.put_number("clock/time", 0.5);
  writer.write(path, path + ".previous");
  return read_file(path);
}

/// Whether it can be opened; then all of its values must be there.
bool opens(const std::string& bytes) {
  try {
    const CheckpointReader reader(bytes, "checkpoint.h5");
    require(reader.has("clock/time") && !reader.has("clock/none") && !reader.has("none/time"),
            "names are found");
    require(reader.number("clock/time") == 0.5 && reader.count("clock/steps") == 12 &&
                reader.text("version") == "0.1.0" && reader.size("sets/water/position") == 6,
            "values are those that were put");
    for (const char* name : {"none", "sets/water/id"}) try {
        reader.number(name);
        require(false, "what is missing or of another kind is refused");
      } catch (const IoError&) {
      }
    return true;
  } catch (const IoError&) {
    return false;
  }
}

}  // namespace

/// The input is a file of its own, and a list of damages: three bytes each, two for the place and
/// one for the bits to flip there; a last odd byte cuts the file.
void run_checkpoint(std::string_view input) {
  static const std::string sound = sound_checkpoint();
  require(!opens(std::string(input)) || input == sound, "a foreign file is no checkpoint");
  std::string damaged = sound;
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(input[k]); };
  std::size_t k = 0;
  for (; k + 2 < input.size(); k += 3) {
    const std::size_t at = (byte(k) << 8 | byte(k + 1)) % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ byte(k + 2));
  }
  if (k < input.size()) damaged.resize(damaged.size() * byte(k) / 256);
  require(opens(damaged) == (damaged == sound),
          "a damaged checkpoint is refused, a sound one is not");
}

}  // namespace sphgeo::fuzz
