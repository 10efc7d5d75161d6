#include "deck/check_context.h"

#include <utility>

namespace sphgeo {

bool CheckContext::given(const std::string& key) const {
  return places_.count(join_path(path_, key)) > 0;
}

Place CheckContext::place(const std::string& key) const {
  return place_in(places_, join_path(path_, key));
}

CheckContext CheckContext::inside(const std::string& key) const {
  return {found_, places_, join_path(path_, key), dimension_, resolution_};
}

void CheckContext::error(const std::string& key, std::string message, std::string help,
                         std::string id) {
  found_.error(std::move(id), place(key), join_path(path_, key), std::move(message),
               std::move(help));
}

void CheckContext::warning(const std::string& key, std::string message, std::string help,
                           std::string id) {
  found_.warning(std::move(id), place(key), join_path(path_, key), std::move(message),
                 std::move(help));
}

}  // namespace sphgeo
