#pragma once
// Findings about a deck for the user: place, key, message and help.

#include <string>
#include <vector>

namespace sphgeo {

/// A place in a deck file or on the command line; line and column count from 1, 0 = unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { note, warning, error };

/// One finding. The message stands alone (lower case, no full stop); help says how to correct it.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string id;  ///< short stable code such as "E012"
  Place place;
  std::string path;  ///< key path such as bodies[0].shape.radius
  std::string message;
  std::string help;  ///< empty when there is no help
};

/// Collects findings so that all of them are reported at once.
class Diagnostics {
 public:
  void add(Diagnostic d) { items_.push_back(std::move(d)); }
  void error(std::string id, Place at, std::string path, std::string message,
             std::string help = {});
  void warning(std::string id, Place at, std::string path, std::string message,
               std::string help = {});
  bool has_errors() const;
  /// Keeps a text that findings point into: a file as it was read, or an override.
  void keep_source(std::string name, std::string text);
  /// Takes over the findings and texts of another collection.
  void append(const Diagnostics& other);
  const std::vector<Diagnostic>& items() const { return items_; }

  /// All findings in the order of their places, each with its line of the file and a caret; after
  /// the first twenty errors only their number.
  std::string render(bool color = false) const;

 private:
  struct Source {
    std::string name;
    std::string text;
  };
  std::vector<Diagnostic> items_;
  std::vector<Source> sources_;  ///< in the order of reading, which is the order of the report
};

}  // namespace sphgeo
