#include "report/scene_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/parallel.h"
#include "report/color_map.h"
#include "report/moments.h"
#include "report/painter.h"

namespace sphgeo {

namespace {

constexpr int levels = 36;  ///< colours of a quantity
constexpr std::size_t kept_values =
    8'000'000;  ///< numbers of frames held in memory at a time; more are read again

/// What a row may show.
struct Quantity {
  std::string field, title;
  std::string of;          ///< the kind of set that has it; empty: of all
  double clipped = 0.01;   ///< share of all values beyond each end of the colours
  bool from_zero = false;  ///< the colours begin at zero
};

/// "water", "soil", "solids": solids may be several sets.
std::string kind_of(const std::string& set) { return set.starts_with("solids") ? "solids" : set; }

const std::vector<Quantity>& known_quantities() {
  static const std::vector<Quantity> known{
      {"velocity", "Speed", "", 0.01, true},
      {"pressure", "Pressure of the water", "water"},
      {"plastic_strain", "Plastic strain of the soil", "soil", 0.02,
       true},  // large in few positions
      {"von_mises", "von Mises stress of the solids", "solids", 0.01, true}};
  return known;
}

bool is_known(const std::string& field) {
  return std::any_of(known_quantities().begin(), known_quantities().end(),
                     [&](const Quantity& q) { return q.field == field; });
}

const Quantity* titled(const std::string& title) {
  const auto it = std::find_if(known_quantities().begin(), known_quantities().end(),
                               [&](const Quantity& q) { return q.title == title; });
  return it == known_quantities().end() ? nullptr : &*it;
}

struct RunFrames {
  const RunRecord* run = nullptr;
  std::vector<std::optional<double>> moments;  ///< by wanted time: the time of the frame
  std::map<std::string, double> spacing;       ///< by set, m
  Aabb box;                                    ///< of the particles at all moments
  Aabb walls;
};

std::vector<double> times_of(const RunRecord& run) {
  std::set<double> times;
  for (const auto& [set, frames] : run.frames)
    for (const auto& f : frames) times.insert(f.time);
  return {times.begin(), times.end()};
}

class Paintings {
 public:
  Paintings(std::span<const RunRecord> runs, const PictureWishes& wishes) : wishes_(wishes) {
    choose_times(runs);
    survey();
    quantities_ = known_quantities();
    if (!ranges_.empty()) return;
    // A deck may write other fields only: one of them is shown.
    all_fields_ = true;
    reader_ = MomentReader(kept_values, [](const std::string&) { return true; });
    survey();
    quantities_.clear();
    for (const auto& [field, range] : ranges_)
      if (field != "id" && field != "part" && quantities_.size() < 2) {
        quantities_.push_back({field, field, ""});
        std::replace(quantities_.back().title.begin(), quantities_.back().title.end(), '_', ' ');
      }
  }

  ScenePictures operator()() {
    ScenePictures out;
    out.times = times_;
    for (const Quantity& q : quantities_) {
      const auto range = ranges_.find(all_fields_ ? q.field : q.title);
      if (range == ranges_.end()) continue;
      out.rows.push_back(
          {q.title, range->second.unit, range->second.low, range->second.high,
           range->second.clipped,
           std::vector(runs_.size(), std::vector<std::optional<Shot>>(times_.size()))});
      fields_.push_back(q);
    }
    if (times_.empty()) return out;
    if (out.rows.empty()) {  // all fields are uniform: the particles as such
      out.rows.push_back(
          {"Particles", "", 0, 0, false,
           std::vector(runs_.size(), std::vector<std::optional<Shot>>(times_.size()))});
      fields_.push_back({"", "", "none"});
    }
    int width = wishes_.width;
    for (int attempt = 0; attempt < 6; ++attempt) {
      paint_all(out, width);
      if (out.bytes() <= wishes_.most_bytes) break;
      const double share =
          std::sqrt(static_cast<double>(wishes_.most_bytes) / static_cast<double>(out.bytes()));
      width = std::max(60, static_cast<int>(width * std::min(0.85, 0.95 * share)));
    }
    out.problems.assign(reader_.problems().begin(), reader_.problems().end());
    return out;
  }

 private:
  struct Range {
    double low = 0, high = 1;
    std::string unit;
    bool clipped = false;
  };

  void choose_times(std::span<const RunRecord> runs) {
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const RunRecord& run : runs)
      if (const auto times = times_of(run); !times.empty()) {
        first = std::min(first, times.front());
        last = std::max(last, times.back());
      }
    if (first > last) return;
    const int n = first == last ? 1 : std::max(1, wishes_.times);
    for (int k = 0; k < n; ++k)
      times_.push_back(n == 1 ? last : first + (last - first) * k / (n - 1));
    for (const RunRecord& run : runs) {
      RunFrames& frames = runs_.emplace_back();
      frames.run = &run;
      const std::vector<double> times = times_of(run);
      for (const double wanted : times_) {
        std::optional<double>& moment = frames.moments.emplace_back();
        if (times.empty()) continue;
        const double nearest = *std::min_element(
            times.begin(), times.end(),
            [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
        // A run that ended long before has no picture of this time.
        const double step = n > 1 ? (last - first) / (n - 1) : 1;
        const bool repeated =
            frames.moments.size() > 1 && frames.moments[frames.moments.size() - 2] == nearest;
        if (std::abs(nearest - wanted) <= 0.5 * step * (1 + 1e-9) && !repeated) moment = nearest;
      }
    }
    // When the frames are few, several wanted times have none in any run.
    for (std::size_t k = times_.size(); k-- > 0;)
      if (std::none_of(runs_.begin(), runs_.end(),
                       [&](const RunFrames& r) { return r.moments[k].has_value(); })) {
        times_.erase(times_.begin() + static_cast<long>(k));
        for (RunFrames& r : runs_) r.moments.erase(r.moments.begin() + static_cast<long>(k));
      }
  }

  /// The known quantity that a field of this set is; nullptr when it is none.
  static const Quantity* shown_by(const std::string& field, const std::string& set) {
    for (const Quantity& q : known_quantities())
      if (q.field == field && (q.of.empty() || q.of == kind_of(set))) return &q;
    return nullptr;
  }

  const Moment& moment(std::size_t run, std::size_t time, Moment& scratch) {
    return reader_(*runs_[run].run, *runs_[run].moments[time], scratch);
  }

  /// Reads the frames once: which quantities there are, in which ranges, and where.
  void survey() {
    std::map<std::string, std::vector<double>> samples, at_start;
    std::map<std::string, std::string> units;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (std::size_t t = 0; t < times_.size(); ++t) {
        if (!runs_[r].moments[t]) continue;
        Moment scratch;
        const Moment& now = moment(r, t, scratch);
        for (const WallLines* walls : now.walls) runs_[r].walls.extend(walls->box);
        for (const auto& [set, frame] : now.sets) {
          look(runs_[r], set, frame, t == 0);
          for (const VtuColumn& c : frame.point_fields) {
            const Quantity* q = shown_by(c.name, set);
            if (!q && !all_fields_) continue;
            const std::string& title = q ? q->title : c.name;
            units[title] = c.unit;
            const std::size_t stride = 1 + c.tuples() / 50'000;
            for (std::size_t i = 0; i < c.tuples(); i += stride)
              if (const double v = c.magnitude(i); std::isfinite(v))
                (t == 0 && times_.size() > 2 ? at_start : samples)[title].push_back(v);
          }
        }
      }
    for (auto& [title, values] : samples) {
      const Quantity* known = titled(title);
      const Quantity rules = known ? *known : Quantity{};
      std::optional<Range> range = range_of(values, rules);
      // The first frame is the initial state, not a result: it may widen the range only moderately.
      values.insert(values.end(), at_start[title].begin(), at_start[title].end());
      const std::optional<Range> all = range_of(values, rules);
      if (all && (!range || all->high - all->low < 2 * (range->high - range->low))) range = all;
      if (!range) continue;
      range->clipped = range->clipped || !all || all->clipped || all->high > range->high ||
                       all->low < range->low;
      range->unit = units[title];
      ranges_[title] = *range;
    }
  }

  /// Extends the visible box; a few distant particles do not reduce the scale.
  static void look(RunFrames& run, const std::string& set, const VtuFrame& frame, bool first) {
    if (frame.points.empty()) return;
    Aabb box;
    if (!run.spacing.contains(set)) run.spacing[set] = typical_spacing(frame.points);
    std::vector<double> values;
    for (int axis = 0; axis < 3; ++axis) {
      values.clear();
      for (const Vec3& p : frame.points)
        if (std::isfinite(p[axis])) values.push_back(p[axis]);
      if (values.empty()) return;
      const auto most = static_cast<double>(values.size() - 1);
      const double cut = first ? 0 : 0.002;
      const auto at = [&](double share) {
        const auto k = values.begin() + static_cast<long>(share * most);
        std::nth_element(values.begin(), k, values.end());
        return *k;
      };
      box.lo[axis] = at(cut);
      box.hi[axis] = at(1 - cut);
    }
    run.box.extend(box.grown(0.5 * run.spacing[set]));
  }

  static std::optional<Range> range_of(std::vector<double> values, const Quantity& rules) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](double part) {
      return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
    };
    Range range{at(rules.clipped), at(1 - rules.clipped), "", false};
    // Where almost all particles are at rest, the range still covers the moving ones.
    if (!(range.high > range.low)) range = {values.front(), values.back(), "", false};
    if (rules.from_zero || (range.low > 0 && range.low < 0.3 * range.high) ||
        (range.low < 0 && -range.low < 0.1 * range.high))
      range.low = 0;
    if (!(range.high - range.low > 1e-12 * std::max(std::abs(range.high), std::abs(range.low))))
      return {};
    range.clipped = values.back() > range.high || values.front() < range.low;
    return range;
  }

  /// The quantities and region of the pictures; the same for runs of the same scene.
  Aabb window(const RunFrames& run) const {
    Aabb particles = run.box, walls = run.walls;
    const std::string title = text_at(run.run->summary, "/title");
    for (const RunFrames& other : runs_) {
      if (title.empty() || text_at(other.run->summary, "/title") != title ||
          dimension(*other.run) != dimension(*run.run))
        continue;
      particles.extend(other.box);
      walls.extend(other.walls);
    }
    return picture_box(particles, walls);
  }

  int dimension(const RunRecord& run) const {
    if (run.model) return run.model->dimension;
    return number_at(run.summary, "/dimension") == 3.0 ? 3 : 2;
  }

  void paint_all(ScenePictures& out, int width) {
    // The same scale for all runs, when their regions have about the same size.
    std::vector<View> views;
    for (const RunFrames& run : runs_)
      views.push_back(window(run).empty() ? View{}
                                          : view_of(window(run), dimension(*run.run), width,
                                                    std::max(60, width * 4 / 5)));
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (std::size_t t = 0; t < times_.size(); ++t) {
        if (!runs_[r].moments[t] || window(runs_[r]).empty()) continue;
        Moment scratch;
        const Moment& now = moment(r, t, scratch);
        parallel_blocks(static_cast<Index>(fields_.size()), 1, [&](Index q, Index, Index) {
          const auto k = static_cast<std::size_t>(q);
          const Picture picture = paint(runs_[r], now, views[r], fields_[k], out.rows[k]);
          out.rows[k].shots[r][t] =
              Shot{*runs_[r].moments[t], png(picture), picture.width, picture.height};
        });
      }
  }

  static Picture paint(const RunFrames& run, const Moment& now, const View& view,
                       const Quantity& quantity, const PictureRow& row) {
    std::vector<Color> colors = map_colors(levels);
    const auto wall = static_cast<int>(colors.size());
    colors.push_back({0.52, 0.54, 0.57, 1});
    for (const char* kind : {"water", "soil", "solids", ""}) colors.push_back(set_color(kind));
    const auto plain = [&](const std::string& set) {
      const std::string kind = kind_of(set);
      return static_cast<std::uint8_t>(wall + (kind == "water"    ? 1
                                               : kind == "soil"   ? 2
                                               : kind == "solids" ? 3
                                                                  : 4));
    };
    Painter painter(view, std::move(colors));
    // Sets that show the quantity are drawn last: water overlaps soil, where both would be drawn.
    std::vector<std::pair<int, const std::pair<const std::string, VtuFrame>*>> order;
    for (const auto& entry : now.sets) {
      const bool shows = entry.second.find(quantity.field) &&
                         (quantity.of.empty() || quantity.of == kind_of(entry.first));
      const int layer = kind_of(entry.first) == "solids" ? 2
                        : kind_of(entry.first) == "soil" ? 1
                                                         : 0;
      order.emplace_back(layer + (shows && !quantity.of.empty() ? 10 : 0), &entry);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto draw_walls = [&] {
      for (const WallLines* walls : now.walls)
        for (const auto& [a, b] : walls->lines) painter.line(a, b, 2, wall);
    };
    if (!view.flat) draw_walls();
    for (const auto& [layer, entry] : order) {
      const auto& [set, frame] = *entry;
      const VtuColumn* column =
          quantity.of.empty() || quantity.of == kind_of(set) ? frame.find(quantity.field) : nullptr;
      std::vector<std::uint8_t> tints(frame.points.size(), plain(set));
      if (column && column->tuples() == frame.points.size())
        for (std::size_t i = 0; i < tints.size(); ++i) {
          const double share = (column->magnitude(i) - row.low) / (row.high - row.low);
          tints[i] = static_cast<std::uint8_t>(share > 0 ? std::min(share * levels, levels - 1.0)
                                                         : 0.0);  // NaN: the lowest
        }
      const auto known = run.spacing.find(set);
      const double spacing =
          known != run.spacing.end() && known->second > 0 ? known->second : 4 / view.scale;
      painter.discs(frame.points, disc_cover(view, spacing) * spacing, tints,
                    layer * 0.25 * spacing);
    }
    if (view.flat) draw_walls();
    return painter.picture();
  }

  PictureWishes wishes_;
  std::vector<double> times_;
  std::vector<RunFrames> runs_;
  std::vector<Quantity> quantities_, fields_;
  std::map<std::string, Range> ranges_;  ///< by title, of unknown quantities by field
  MomentReader reader_{kept_values, [](const std::string& field) { return is_known(field); }};
  bool all_fields_ = false;
};

}  // namespace

std::size_t ScenePictures::bytes() const {
  std::size_t sum = 0;
  for (const PictureRow& row : rows)
    for (const auto& run : row.shots)
      for (const auto& shot : run)
        if (shot) sum += shot->png.size();
  return sum;
}

ScenePictures paint_runs(std::span<const RunRecord> runs, const PictureWishes& wishes) {
  return Paintings(runs, wishes)();
}

double typical_spacing(std::span<const Vec3> positions) {
  if (positions.size() < 2) return 0;
  std::vector<double> nearest;
  constexpr std::size_t probes = 24;
  for (std::size_t k = 0; k < std::min(probes, positions.size()); ++k) {
    const std::size_t i = k * positions.size() / std::min(probes, positions.size());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < positions.size(); ++j)
      if (j != i) least = std::min(least, (positions[j] - positions[i]).squaredNorm());
    if (std::isfinite(least) && least > 0) nearest.push_back(std::sqrt(least));
  }
  if (nearest.empty()) return 0;
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<long>(nearest.size() / 2),
                   nearest.end());
  return nearest[nearest.size() / 2];
}

Color set_color(const std::string& set) {
  const std::string kind = kind_of(set);
  if (kind == "water") return {0.60, 0.76, 0.90, 1};
  if (kind == "soil") return {0.78, 0.66, 0.47, 1};
  if (kind == "solids") return {0.58, 0.60, 0.65, 1};
  return {0.70, 0.62, 0.72, 1};
}

}  // namespace sphgeo
