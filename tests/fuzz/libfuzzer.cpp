// libFuzzer's entry, compiled once for each target.

#include <cstdint>
#include <cstdlib>

#include "core/parallel.h"
#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const sphgeo::fuzz::Target* target = [] {
    sphgeo::set_threads(1);
    return sphgeo::fuzz::find_target(SPHGEO_FUZZ_TARGET);
  }();
  if (target == nullptr) std::abort();
  if (size <= target->longest) target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
