#pragma once
// The frames of a run: composed in memory while the run waits, written beside it.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/file_image.h"
#include "core/side_thread.h"
#include "deck/model.h"
#include "output/pvd.h"
#include "output/run_folder.h"
#include "output/time_table.h"
#include "run/boundary_mesh.h"
#include "sph/world.h"

namespace sphgeo {

/// Frames of all sets but walls, and of the surfaces of the boundaries, with their collections: a
/// collection lists a frame when its file is on the disk.
template <int Dim>
class FrameOutput {
 public:
  /// `walls` are the boundaries of the model. `files` writes, and must have ended when this does.
  FrameOutput(const Model& model, const World<Dim>& world, const BoundaryMesh& walls,
              const RunFolder& folder, SideThread& files);
  /// Makes the collections, or continues those of the frames that load() knows of. Throws IoError.
  void open();

  /// Begins a frame of the present state. Throws IoError for what was to be written before.
  void write();

  const Index& count() const { return frame_; }
  TimeRow time_row() const { return {"frames", calls_, spent_}; }
  void save(StateSink& sink) const;
  void load(const StateSource& source);

 private:
  /// One file of a frame; without an image the collection names an earlier one.
  struct File {
    PvdFile& collection;
    double time;
    Index number;
    std::string set;
    std::shared_ptr<const FileImage> image;
  };
  File compose_set(const ParticleSet<Dim>& set);
  File compose_boundaries();
  void write(const File& file) const;
  std::vector<std::string> fields_of(const ParticleSet<Dim>& set) const;

  const Model& model_;
  const World<Dim>& world_;
  const BoundaryMesh& walls_;
  RunFolder folder_;
  SideThread& files_;
  std::map<std::string, PvdFile> collections_;  ///< once open, those of the thread that writes
  Index frame_ = 0;
  double last_time_ = -1;  ///< s; -1: no frame yet
  Spent spent_;
  long calls_ = 0;
};

extern template class FrameOutput<2>;
extern template class FrameOutput<3>;

}  // namespace sphgeo
