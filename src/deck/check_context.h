#pragma once
// What a rule across keys knows and reports: the scene's dimension, and findings at deck lines.

#include <string>

#include "core/diagnostic.h"
#include "deck/node.h"

namespace sphgeo {

/// Handed to `Schema::check` rules and to `Shape::inspect`. Keys are relative to the object
/// checked.
class CheckContext {
 public:
  CheckContext(Diagnostics& found, const Places& places, std::string path, int dimension,
               double resolution = 0.0)
      : found_(found),
        places_(places),
        path_(std::move(path)),
        dimension_(dimension),
        resolution_(resolution) {}

  int dimension() const { return dimension_; }
  /// The particle spacing (m), or 0 when it is not known yet.
  double resolution() const { return resolution_; }
  /// Key path of the object checked, such as bodies[0].shape.
  const std::string& path() const { return path_; }
  /// Whether the deck itself gives this key (rather than its default).
  bool given(const std::string& key) const;
  Place place(const std::string& key = {}) const;
  /// The same context for a part of the object, such as "of[1]".
  CheckContext inside(const std::string& key) const;

  /// Reports an error about one key (empty: about the object as a whole).
  void error(const std::string& key, std::string message, std::string help = {},
             std::string id = "E030");
  void warning(const std::string& key, std::string message, std::string help = {},
               std::string id = "W030");

 private:
  Diagnostics& found_;
  const Places& places_;
  std::string path_;
  int dimension_;
  double resolution_;
};

}  // namespace sphgeo
