#include "deck/copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash.h"
#include "core/text.h"

namespace sphgeo {

Schema<Copies> Copies::schema() {
  Schema<Copies> s(
      "copies",
      "Many bodies from one: the key `copies` of a body makes bodies NAME_1, NAME_2 ... of it, at "
      "random positions without overlap. Boulders also differ in their seed.");
  s.required("count", &Copies::count, unit::none, "how many").at_least(1).at_most(10000);
  s.required("region", &Copies::region, unit::none,
             "the region inside of which they are placed; it must be bounded");
  s.optional("sizes", &Copies::sizes, unit::none,
             "smallest and largest scale factor of the shape; the factors of the copies are spread "
             "evenly between them")
      .items(2, 2)
      .above(0);
  s.optional("seed", &Copies::seed, unit::none,
             "another seed gives other sizes, positions and rotations")
      .at_least(0);
  s.optional("gap", &Copies::gap, unit::length,
             "smallest distance between two copies; auto: two spacings, so that they do not touch "
             "at t = 0")
      .at_least(0);
  s.optional("turned", &Copies::turned, unit::none, "whether each copy is rotated at random");
  s.check([](Copies& k, CheckContext& c) {
    if (k.sizes[0] > k.sizes[1])
      c.error("sizes", "the smallest size is larger than the largest", "write [smallest, largest]");
    const Aabb box = k.region->box();
    if (!(box.lo.allFinite() && box.hi.allFinite()))
      c.error("region", "the region is unbounded", "intersect it with a box");
  });
  return s;
}

namespace {

/// A sequence of numbers in [0, 1) from a seed.
struct Draws {
  std::uint64_t seed, next = 0;
  double operator()() { return random_uniform(seed, next++); }
  double between(double a, double b) { return a + (b - a) * (*this)(); }
  /// Evenly spread over all directions, in 2D in the x-z plane.
  Vec3 direction(int dimension) {
    const double angle = 2 * std::numbers::pi * (*this)();
    if (dimension == 2) return {std::cos(angle), 0, std::sin(angle)};
    const double z = between(-1, 1), across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
};

/// Reads a part of the deck before the rest, with its rules. Findings go to `found`.
template <class Read>
bool read_ahead(const DeckReading& reading, Diagnostics& found, Places& places, Read&& read) {
  DeckReading trial(found, places);
  trial.variables = reading.variables;
  trial.dimension = reading.dimension;
  trial.resolution = reading.resolution;
  trial.main_file = reading.main_file;
  trial.folder = reading.folder;
  if (!read(trial) || found.has_errors()) return false;
  for (const auto& rule : trial.rules) rule();
  return !found.has_errors();
}

/// A ball around the center of the shape's box that contains the shape.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

Ball ball_around(const Shape& shape, int dimension) {
  const Aabb box = shape.box();
  const Vec3 center = 0.5 * (box.lo + box.hi);
  const double corner = 0.5 * (box.hi - box.lo).norm();
  constexpr int directions = 500, steps = 128;
  Draws draw{1};
  double reach = 0;
  for (int k = 0; k < directions; ++k) {
    const Vec3 e = draw.direction(dimension);
    double r = corner;
    while (r > reach && shape.signed_distance(center + r * e) > 0) r -= corner / steps;
    reach = std::max(reach, r);
  }
  return {center, std::min(corner, reach + corner / steps)};
}

Node number(double value, const Place& place) {
  Node n = Node::scalar(exact(value));
  n.place = place;
  return n;
}
Node vector(const Vec3& v, const Place& place) {
  Node n = Node::list({number(v.x(), place), number(v.y(), place), number(v.z(), place)});
  n.place = place;
  return n;
}
Node text(std::string value, const Place& place) {
  Node n = Node::scalar(std::move(value));
  n.place = place;
  return n;
}
void put(Node& map, const std::string& key, Node value) {
  if (Entry* e = map.find(key)) e->value = std::move(value);
  else {
    const Place place = value.place;
    map.add(key, std::move(value));
    map.entries.back().place = place;
  }
}

struct Placed {
  double size = 1;
  Vec3 at = Vec3::Zero();
};

/// Sizes and positions, the largest first; fewer than requested when they do not fit.
std::vector<Placed> place(const Copies& copies, const Ball& ball, const DeckReading& reading) {
  constexpr int tries = 2000;
  Draws draw{static_cast<std::uint64_t>(copies.seed)};
  std::vector<Placed> out(static_cast<std::size_t>(copies.count));
  for (Placed& p : out) p.size = draw.between(copies.sizes[0], copies.sizes[1]);
  std::stable_sort(out.begin(), out.end(),
                   [](const Placed& a, const Placed& b) { return a.size > b.size; });
  const double gap = copies.gap.value_or(2 * reading.resolution);
  const Aabb box = copies.region->box();
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double radius = out[k].size * ball.radius;
    const auto fits = [&](const Vec3& at) {
      // The exact distance last: in a composed region it costs a hundred times the others.
      if (copies.region->bound(at) > 0) return false;
      const bool apart = std::all_of(
          out.begin(), out.begin() + static_cast<std::ptrdiff_t>(k), [&](const Placed& o) {
            return (o.at - at).norm() >= radius + o.size * ball.radius + gap;
          });
      return apart && !(copies.region->signed_distance(at) > -radius);
    };
    int left = tries;
    do {
      for (int d = 0; d < 3; ++d) out[k].at[d] = draw.between(box.lo[d], box.hi[d]);
      if (reading.dimension == 2) out[k].at.y() = 0;
    } while (!fits(out[k].at) && --left > 0);
    if (left == 0) {
      out.resize(k);
      break;
    }
  }
  return out;
}

/// The body of one copy.
Node copy_of(const Node& body, std::size_t k, const Placed& placed, const Copies& copies,
             const Ball& ball, int dimension) {
  Node out = body;
  Entry* name = out.find("name");
  if (name) name->value.text += fmt::format("_{}", k + 1);
  Node shape = out.find("shape")->value;
  const Place at = shape.place;
  if (const Entry* type = shape.find("type"); type && type->value.text == "boulder") {
    const Entry* seed = shape.find("seed");
    put(shape, "seed",
        text(seed ? fmt::format("({}) + {}", seed->value.text, k) : fmt::format("{}", k + 1), at));
  }
  Node moved = Node::map();
  moved.place = at;
  put(moved, "type", text("transform", at));
  put(moved, "of", std::move(shape));
  put(moved, "scale", number(placed.size, at));
  if (copies.turned) {
    Draws draw{
        random_bits(static_cast<std::uint64_t>(copies.seed), ~static_cast<std::uint64_t>(k))};
    put(moved, "rotate", number(2 * std::numbers::pi * draw(), at));
    put(moved, "axis", vector(dimension == 2 ? Vec3(0, -1, 0) : draw.direction(3), at));
  }
  put(moved, "about", vector(ball.center, at));
  put(moved, "translate", vector(placed.at - ball.center, at));
  put(out, "shape", std::move(moved));
  return out;
}

/// The copies of a body, or the body itself where its `copies` have errors.
std::vector<Node> expanded(Node body, const std::string& path, DeckReading& reading) {
  const Entry entry = *body.find("copies");
  std::erase_if(body.entries, [](const Entry& e) { return e.key == "copies"; });
  const std::string at = join_path(path, "copies");
  reading.places[at] = entry.place;
  Copies copies;
  Diagnostics found;
  const bool good = read_ahead(reading, found, reading.places, [&](DeckReading& r) {
    return read_mapping(entry.value, {{&schema_of<Copies>(), &copies}}, at, r);
  });
  for (const Diagnostic& d : found.items()) {
    if (d.severity == Severity::error) reading.error(d.id, d.place, d.path, d.message, d.help);
  }
  if (!good) return {std::move(body)};
  if (const Entry* clamped = body.find("clamped")) {
    reading.error("E030", clamped->place, path, "copies cannot be clamped",
                  "write clamped bodies as separate entries");
    return {std::move(body)};
  }
  // A shape that cannot be read is reported when the body is read.
  const Entry* shape = body.find("shape");
  if (!shape) return {std::move(body)};
  std::shared_ptr<const Shape> original;
  Diagnostics unheard;
  Places nowhere;
  const Key key("shape", value_type<std::shared_ptr<const Shape>>(), unit::none, true, "",
                [](void* p) { return p; });
  if (!read_ahead(reading, unheard, nowhere, [&](DeckReading& r) {
        return key.type().read(shape->value, key, "shape", r, &original);
      }))
    return {std::move(body)};
  const Ball ball = ball_around(*original, reading.dimension);
  if (!(ball.radius > 0 && std::isfinite(ball.radius))) {
    reading.error("E030", entry.place, at, "the shape of the copies is unbounded",
                  "copies need a shape of finite size");
    return {std::move(body)};
  }
  const std::vector<Placed> places = place(copies, ball, reading);
  if (places.size() < static_cast<std::size_t>(copies.count)) {
    reading.error(
        "E030", entry.place, at,
        fmt::format("only {} of {} copies fit into the region", places.size(), copies.count),
        fmt::format("each needs a ball of {} m times its size, and the gap: a larger region, "
                    "smaller sizes, or fewer copies",
                    exact(ball.radius)));
    return {std::move(body)};
  }
  std::vector<Node> out;
  for (std::size_t k = 0; k < places.size(); ++k)
    out.push_back(copy_of(body, k, places[k], copies, ball, reading.dimension));
  return out;
}

}  // namespace

void expand_copies(Node& root, DeckReading& reading) {
  Entry* bodies = root.find("bodies");
  if (!bodies || bodies->value.kind != Node::Kind::list || reading.dimension == 0 ||
      !(reading.resolution > 0))
    return;
  std::vector<Node> all;
  for (std::size_t k = 0; k < bodies->value.items.size(); ++k) {
    Node& body = bodies->value.items[k];
    if (body.kind != Node::Kind::map || !body.find("copies")) {
      all.push_back(std::move(body));
      continue;
    }
    for (Node& copy : expanded(std::move(body), fmt::format("bodies[{}]", k), reading))
      all.push_back(std::move(copy));
  }
  bodies->value.items = std::move(all);
}

}  // namespace sphgeo
