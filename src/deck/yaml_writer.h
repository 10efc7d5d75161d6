#pragma once
// Writes a tree as YAML that the strict reader takes back unchanged.

#include <string>

#include "deck/node.h"

namespace sphgeo {

/// Block style for mappings and lists of mappings, one line for lists of scalars.
std::string write_yaml(const Node& node);

}  // namespace sphgeo
