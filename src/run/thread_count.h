#pragma once
// Number of threads that a scene can use.

namespace sphgeo {

/// `asked`, or when that is 0 as many as the machine has, but no more than one per 2000 particles.
int sensible_threads(long particles, int asked);

}  // namespace sphgeo
