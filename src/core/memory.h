#pragma once
// What the machine says about memory.

#include <cstdint>

namespace sphgeo {

/// Bytes of main memory that this process occupies now; 0 when the system does not tell.
std::uint64_t resident_memory();

/// Bytes that this process may still take: what the machine has available, less where a control
/// group (a container) or `ulimit -v` allows less. The largest number when the system does not
/// tell.
std::uint64_t available_memory();

}  // namespace sphgeo
