#include "core/version.h"

namespace sphgeo {

const char* version() { return SPHGEO_VERSION; }

}  // namespace sphgeo
