#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "deck/model.h"

namespace sphgeo {

int schema_command() {
  std::cout << json_schema().dump(2) << "\n";
  return 0;
}

}  // namespace sphgeo
