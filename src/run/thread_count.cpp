#include "run/thread_count.h"

#include <algorithm>
#include <thread>

namespace sphgeo {

int sensible_threads(long particles, int asked) {
  if (asked > 0) return asked;
  const long cores = std::max(1u, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp(particles / 2000, 1L, cores));
}

}  // namespace sphgeo
