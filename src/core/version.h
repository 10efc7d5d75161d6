#pragma once
// The version of the program.

namespace sphgeo {

/// "0.1.0": what files and summaries name as their maker.
const char* version();

}  // namespace sphgeo
