#include "run/frame_output.h"

#include <utility>

#include "core/stopwatch.h"
#include "run/set_frame.h"
#include "run/wishes.h"

namespace sphgeo {

template <int Dim>
FrameOutput<Dim>::FrameOutput(const Model& model, const World<Dim>& world,
                              const BoundaryMesh& walls, const RunFolder& folder, SideThread& files)
    : model_(model), world_(world), walls_(walls), folder_(folder), files_(files) {}

template <int Dim>
void FrameOutput<Dim>::open() {
  const auto open_one = [&](const std::string& set) {
    const std::string path = folder_.pvd(set);
    if (frame_ > 0) collections_.try_emplace(set, PvdFile::resume(path, last_time_));
    else collections_.try_emplace(set, path);
  };
  for (const auto& set : world_.sets())
    if (set->phase() != "wall") open_one(set->name());
  if (!model_.boundaries.empty()) open_one("boundaries");
}

template <int Dim>
void FrameOutput<Dim>::write() {
  const Stopwatch watch(spent_);
  files_.wait();  // what it writes takes memory as well
  std::vector<File> frame;
  for (const auto& set : world_.sets())
    if (set->phase() != "wall") frame.push_back(compose_set(*set));
  if (!model_.boundaries.empty()) frame.push_back(compose_boundaries());
  files_.begin([this, frame = std::move(frame)] {
    for (const File& file : frame) write(file);
  });
  ++frame_;
  last_time_ = world_.clock.time;
  ++calls_;
}

template <int Dim>
typename FrameOutput<Dim>::File FrameOutput<Dim>::compose_set(const ParticleSet<Dim>& set) {
  VtuOptions options;
  options.time = world_.clock.time;
  options.precision =
      model_.output.frames.precision == "float64" ? VtuPrecision::float64 : VtuPrecision::float32;
  return {collections_.at(set.name()), world_.clock.time, frame_, set.name(),
          std::make_shared<FileImage>(set_frame(set, fields_of(set), options))};
}

template <int Dim>
typename FrameOutput<Dim>::File FrameOutput<Dim>::compose_boundaries() {
  File file{collections_.at("boundaries"), world_.clock.time, frame_, "boundaries", nullptr};
  // Walls at rest are written once and listed at every time.
  if (!boundaries_move(model_)) file.number = 0;
  if (file.number == frame_)
    file.image = std::make_shared<FileImage>(boundary_frame(walls_, model_, file.time));
  return file;
}

template <int Dim>
void FrameOutput<Dim>::write(const File& file) const {
  if (file.image) file.image->write(folder_.frame(file.set, file.number));
  file.collection.add(file.time, RunFolder::frame_name(file.set, file.number));
}

template <int Dim>
std::vector<std::string> FrameOutput<Dim>::fields_of(const ParticleSet<Dim>& set) const {
  const auto& asked = model_.output.frames.fields;
  std::vector<std::string> names =
      asked.empty() ? usual_fields(set.name(), world_.find("water") && world_.find("soil")) : asked;
  std::erase_if(names, [&](const std::string& f) { return !set.fields().contains(f); });
  return names;
}

template <int Dim>
void FrameOutput<Dim>::save(StateSink& sink) const {
  sink.put_count("output/frames/count", frame_);
  sink.put_number("output/frames/last_time", last_time_);
  put_spent(sink, "output/frames/spent", spent_);
  sink.put_count("output/frames/calls", calls_);
}

template <int Dim>
void FrameOutput<Dim>::load(const StateSource& source) {
  frame_ = source.count("output/frames/count");
  last_time_ = source.number("output/frames/last_time");
  spent_ = spent_of(source, "output/frames/spent");
  calls_ = source.count("output/frames/calls");
}

template class FrameOutput<2>;
template class FrameOutput<3>;

}  // namespace sphgeo
