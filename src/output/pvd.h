#pragma once
// The .pvd file that lists the frames of one set with their times.

#include <string>
#include <vector>

namespace sphgeo {

/// Keeps a ParaView collection valid after every frame: it is replaced as a whole each time, so a
/// killed run can be opened up to its last frame.
class PvdFile {
 public:
  /// A new, empty collection; the file appears with the first frame.
  explicit PvdFile(std::string path) : path_(std::move(path)) {}

  /// Continues the collection that sphgeo wrote earlier, without its frames later than `last_time`
  /// (s). Throws IoError when the file cannot be read or was not written by sphgeo.
  static PvdFile resume(const std::string& path, double last_time);

  /// The collection that a file of sphgeo holds. Throws as resume().
  static PvdFile read(const std::string& path);

  /// Adds a frame (its path relative to the .pvd file) and replaces the file. Throws IoError.
  /// Frames at that time or later are replaced; a file may be named at several times.
  void add(double time, const std::string& frame);
  /// Drops the frames later than `last_time` (s) and replaces the file.
  void truncate_after(double last_time);

  struct Frame {
    double time;  ///< s
    std::string file;
  };
  const std::vector<Frame>& frames() const { return frames_; }

 private:
  void write() const;

  std::string path_;
  std::vector<Frame> frames_;
};

}  // namespace sphgeo
