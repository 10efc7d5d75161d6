#include "report/moments.h"

#include <algorithm>

#include "core/error.h"
#include "report/painter.h"

namespace sphgeo {

namespace {

WallLines lines_of(const VtuFrame& frame) {
  WallLines walls;
  for (const Vec3& p : frame.points) walls.box.extend(p);
  for (const auto& [a, b] : outline(frame.points, frame.corners_per_cell, frame.corners))
    walls.lines.emplace_back(frame.points[static_cast<std::size_t>(a)],
                             frame.points[static_cast<std::size_t>(b)]);
  return walls;
}

std::size_t values_in(const Moment& moment) {
  std::size_t values = 0;
  for (const auto& [set, frame] : moment.sets) {
    values += 3 * frame.points.size();
    for (const VtuColumn& c : frame.point_fields) values += c.values.size();
  }
  return values;
}

}  // namespace

Moment MomentReader::load(const RunRecord& run, double time) {
  Moment moment;
  VtuReading reading;
  reading.wanted = wanted_;
  for (const auto& [set, frames] : run.frames) {
    const auto frame =
        std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.time == time; });
    if (frame == frames.end()) continue;
    if (const auto known = walls_.find(frame->file); known != walls_.end()) {
      moment.walls.push_back(&known->second);
      continue;
    }
    try {
      VtuFrame read = read_vtu(frame->file, reading);
      if (read.corners_per_cell != 1)
        moment.walls.push_back(&walls_.emplace(frame->file, lines_of(read)).first->second);
      else moment.sets.emplace(set, std::move(read));
    } catch (const Error& e) {
      problems_.insert(e.what());
    }
  }
  return moment;
}

const Moment& MomentReader::operator()(const RunRecord& run, double time, Moment& scratch) {
  if (const auto it = kept_.find({&run, time}); it != kept_.end()) return it->second;
  Moment loaded = load(run, time);
  const std::size_t values = values_in(loaded);
  if (values_ + values <= most_values_) {
    values_ += values;
    return kept_.emplace(std::pair{&run, time}, std::move(loaded)).first->second;
  }
  scratch = std::move(loaded);
  return scratch;
}

}  // namespace sphgeo
